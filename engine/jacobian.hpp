// Forward-mode derivative of a chain's output with respect to all its constants.
#pragma once

#include <cstddef>

#include "chain.hpp"

namespace hyst {

// Of every stage the derivative of its row, or where it has none the kernel's own; or the kernel's own
// of all.
enum class Derivative { automatic, kernel };

// jacobian: samples x parameter_count, row-major. The columns follow the stages in the order the
// signal passes them; inside a stage: affine gain, offset; play or stop r; dead zone weights,
// thresholds; PI p0, p_1..p_n, r_1..r_n. At a kink the derivative is one-sided.
void jacobian(const Chain &chain, double *state, const double *u, std::size_t samples,
              Derivative derivative, double *jacobian);

}  // namespace hyst
