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

// The same, by the kernel for every stage with a memory, from a memory that depends on the constants: `memory`, state length x
// parameter_count, row-major, holds its derivatives. State and derivatives go on with the record, so
// that the next stretch of it takes up where this one ends; `signal`, u on entry, is y on exit. Where
// constants change in between, the derivatives are those of the path that was taken.
void carry_jacobian(const Chain &chain, double *state, double *memory, double *signal,
                    std::size_t samples, double *jacobian);

}  // namespace hyst
