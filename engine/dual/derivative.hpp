// The derivative of a kind of stage that has none of its own: the kernel's. The core's step,
// compiled with a number that carries tangents, is run with as many columns of the Jacobian at a
// time as a number has tangents. Free of the core's number type, so that every number type may
// include it.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "../kinds/tangents.hpp"

namespace hyst {

// What an operator says of a stage: kinds::Given, in double.
struct Said {
    const std::string &kind, &form;
    const std::vector<double> &constants;
    const std::map<std::string, std::vector<double>> &fixed;
    const std::map<std::string, std::size_t> &choices;
    double dt;
    std::vector<Said> inside;
};

// Columns [first, first + count) of the rows of a record.
struct Columns {
    const double *u;
    double *y;
    double *rows;
    std::size_t samples, stride, incoming, first, count;
};

// Runs a stage over a record: the place of its kind, its structure, its state.
using Pass = void (*)(std::size_t kind, const void *model, void *state, const Columns &columns);

// The memory of a stage with its derivatives by the columns of the record, a row of `stride` numbers
// for each entry. Without tangents it depends on none, and is left as it is.
struct Remembered {
    double *state;
    double *tangents;
    std::size_t stride;
};

void kernel_jacobian(const Said &said, const Remembered &memory, std::size_t length,
                     const Tangents &tangents);

}  // namespace hyst
