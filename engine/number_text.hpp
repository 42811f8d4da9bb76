// Columns of numbers as text: the shortest digits that name each double, and back.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace hyst {

// Whether the standard library this was built with can do either; where not, both below throw.
bool has_number_text();

// Appends rows [start, stop) of the columns, cells separated by commas and lines ended by a line
// feed. Each number is written as repr() of Python writes it.
void append_rows(const std::vector<const double *> &columns, std::size_t start, std::size_t stop,
                 std::string &text);

// Parses lines of `count` plain numbers from begin to end into rows of the targets; a null target
// is a column that is not wanted, and only counted. A separator of 0 is a run of white space.
// Gives false, leaving the targets as they may be, where a line has more or fewer cells than count,
// or a wanted cell is no plain number within the range of a double.
bool parse_rows(const char *begin, const char *end, char separator,
                const std::vector<double *> &targets, std::size_t rows);

}  // namespace hyst
