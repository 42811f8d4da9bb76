/* A number whose derivative is recorded on a tape: HYST_REAL_HEADER of hyst/real.h.
 *
 * The values are those of double, as in real.h. A Tangent is a place on the tape, where a sum of at
 * most two earlier places with factors stands; 0 is what depends on nothing. So the rules of
 * dual/rules, which are written in tangents, hold here as they are. Included inside a namespace, by
 * core.hpp, after <stddef.h>. */
#define HYST_INLINE static inline __attribute__((always_inline))

struct Entry {
    double by_a, by_b;
    uint32_t a, b;
};

/* What is being recorded; each thread has its own. */
struct Tape {
    Entry *entries;
    uint32_t count, room;
};

uint32_t grow(Tape &tape, Entry entry);
extern thread_local Tape tape;

HYST_INLINE uint32_t record(double by_a, uint32_t a, double by_b, uint32_t b)
{
    const Entry entry = {by_a, by_b, a, b};
    Tape &to = tape;
    if (to.count == to.room) {
        return grow(to, entry);
    }
    to.entries[to.count] = entry;
    return to.count++;
}

struct Tangent {
    uint32_t place = 0;
};

HYST_INLINE Tangent sum_of(double by_a, Tangent a, double by_b, Tangent b)
{
    if (a.place == 0 && b.place == 0) {
        return {};
    }
    return {record(by_a, a.place, by_b, b.place)};
}

HYST_INLINE Tangent operator+(Tangent a, Tangent b)
{
    return b.place == 0 ? a : a.place == 0 ? b : sum_of(1.0, a, 1.0, b);
}
HYST_INLINE Tangent operator-(Tangent a, Tangent b)
{
    return b.place == 0 ? a : sum_of(1.0, a, -1.0, b);
}
HYST_INLINE Tangent operator-(Tangent a) { return sum_of(-1.0, a, 0.0, {}); }
HYST_INLINE Tangent operator*(double a, Tangent b) { return sum_of(a, b, 0.0, {}); }
HYST_INLINE Tangent operator/(Tangent a, double b) { return sum_of(1.0 / b, a, 0.0, {}); }

struct hyst_real {
    double v;
    Tangent d;

    hyst_real() = default;
    constexpr hyst_real(double value) : v(value), d{} {}
    constexpr hyst_real(double value, Tangent tangent) : v(value), d(tangent) {}
    explicit operator size_t() const { return static_cast<size_t>(v); }
};

HYST_INLINE hyst_real operator*(hyst_real a, hyst_real b)
{
    return {a.v * b.v, sum_of(b.v, a.d, a.v, b.d)};
}
HYST_INLINE hyst_real operator/(hyst_real a, hyst_real b)
{
    const double quotient = a.v / b.v;
    return {quotient, sum_of(1.0 / b.v, a.d, -quotient / b.v, b.d)};
}
#include "arithmetic.h"

HYST_INLINE hyst_real hyst_select(bool condition, hyst_real a, hyst_real b)
{
    return condition ? a : b;
}

#define HYST_REAL(literal) literal
#define HYST_SELECT(condition, a, b) hyst_select(condition, a, b)
#define HYST_ROUNDED(exact, rounded) hyst_real((rounded).v, (exact).d)
