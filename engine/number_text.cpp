#include "number_text.hpp"

#include <charconv>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <system_error>

namespace hyst {
namespace {

// Between these powers of ten Python writes all digits before and behind the point.
[[maybe_unused]] constexpr int lowest_fixed = -4, highest_fixed = 16;
// A sign, 17 digits, a point, an exponent.
[[maybe_unused]] constexpr std::size_t longest = 32;

#ifdef __cpp_lib_to_chars

// Moves the point of d.ddd behind `places` more digits, and fills up with zeros.
char *fixed(const char *digits, int count, int exponent, char *out) {
    if (exponent < 0) {
        *out++ = '0';
        *out++ = '.';
        for (int k = -1; k > exponent; --k) *out++ = '0';
        std::memcpy(out, digits, static_cast<std::size_t>(count));
        return out + count;
    }
    for (int k = 0; k <= exponent; ++k) *out++ = k < count ? digits[k] : '0';
    *out++ = '.';
    if (count <= exponent + 1) *out++ = '0';
    for (int k = exponent + 1; k < count; ++k) *out++ = digits[k];
    return out;
}

char *written(double value, char *out) {
    if (std::isnan(value)) return static_cast<char *>(std::memcpy(out, "nan", 3)) + 3;
    if (std::signbit(value)) *out++ = '-';
    value = std::fabs(value);
    if (std::isinf(value)) return static_cast<char *>(std::memcpy(out, "inf", 3)) + 3;
    char text[longest];
    const char *end = std::to_chars(text, text + longest, value, std::chars_format::scientific).ptr;
    const char *mark = static_cast<const char *>(
        std::memchr(text, 'e', static_cast<std::size_t>(end - text)));
    int exponent = 0;
    for (const char *digit = mark + 2; digit < end; ++digit) exponent = 10 * exponent + (*digit - '0');
    if (mark[1] == '-') exponent = -exponent;
    if (exponent < lowest_fixed || exponent >= highest_fixed) {
        const std::size_t size = static_cast<std::size_t>(end - text);
        return static_cast<char *>(std::memcpy(out, text, size)) + size;
    }
    char digits[longest];
    int count = 0;
    for (const char *each = text; each < mark; ++each) {
        if (*each != '.') digits[count++] = *each;
    }
    return fixed(digits, count, exponent, out);
}

bool is_blank(char sign, char separator) {
    return sign == ' ' || (sign == '\t' && separator != '\t');
}

const char *past_blanks(const char *place, const char *end, char separator) {
    while (place < end && is_blank(*place, separator)) ++place;
    return place;
}

// Reads a number; null where there is none. from_chars takes no plus sign, but words such as inf.
const char *number(const char *place, const char *end, double &value) {
    const char *first = place;
    if (first < end && (*first == '+' || *first == '-')) ++first;
    if (first == end || !((*first >= '0' && *first <= '9') || *first == '.')) return nullptr;
    const auto found = std::from_chars(*place == '+' ? first : place, end, value);
    return found.ec == std::errc() ? found.ptr : nullptr;
}

// Passes over a cell that is not wanted; null where it is empty.
const char *passed(const char *place, const char *end, char separator) {
    const char *first = place;
    while (place < end && *place != separator && !(separator == 0 && is_blank(*place, 0))) ++place;
    return place == first ? nullptr : place;
}

bool line(const char *place, const char *end, char separator, const std::vector<double *> &targets,
          std::size_t row) {
    for (std::size_t k = 0; k < targets.size(); ++k) {
        const char *cell = past_blanks(place, end, separator);
        if (k > 0) {
            if (separator == 0) {
                if (cell == place) return false;
            } else {
                if (cell == end || *cell != separator) return false;
                cell = past_blanks(cell + 1, end, separator);
            }
        }
        place = targets[k] != nullptr ? number(cell, end, targets[k][row])
                                      : passed(cell, end, separator);
        if (place == nullptr) return false;
    }
    return past_blanks(place, end, separator) == end;
}

#endif

}  // namespace

#ifdef __cpp_lib_to_chars

bool has_number_text() { return true; }

void append_rows(const std::vector<const double *> &columns, std::size_t start, std::size_t stop,
                 std::string &text) {
    char cell[2 * longest];
    for (std::size_t row = start; row < stop; ++row) {
        for (std::size_t k = 0; k < columns.size(); ++k) {
            char *end = written(columns[k][row], cell);
            *end++ = k + 1 < columns.size() ? ',' : '\n';
            text.append(cell, static_cast<std::size_t>(end - cell));
        }
    }
}

bool parse_rows(const char *begin, const char *end, char separator,
                const std::vector<double *> &targets, std::size_t rows) {
    std::size_t row = 0;
    for (const char *place = begin; row < rows; ++row) {
        const void *feed = std::memchr(place, '\n', static_cast<std::size_t>(end - place));
        const char *stop = feed != nullptr ? static_cast<const char *>(feed) : end;
        if (!line(place, stop, separator, targets, row)) return false;
        if (stop == end) return row + 1 == rows;
        place = stop + 1;
    }
    return true;
}

#else

bool has_number_text() { return false; }

void append_rows(const std::vector<const double *> &, std::size_t, std::size_t, std::string &) {
    throw std::logic_error("built without conversions of numbers to text");
}

bool parse_rows(const char *, const char *, char, const std::vector<double *> &, std::size_t) {
    throw std::logic_error("built without conversions of numbers to text");
}

#endif

}  // namespace hyst
