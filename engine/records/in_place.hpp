// Records that become their own outputs, with the bits they have elsewhere.
#pragma once

#include <cstddef>

#include "evaluation.hpp"

namespace hyst {

// As `evaluate` from y into y. Where a sample is refused its index is returned and the states are as
// before, but samples before it may be outputs already.
std::size_t evaluate_in_place(const Chain &chain, double *states, double *y, std::size_t rows,
                              std::size_t samples, const Options &options);

}  // namespace hyst
