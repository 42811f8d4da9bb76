// Reverse-mode derivative of a chain: from what its output is multiplied by to its input and constants.
#pragma once

#include <cstddef>

#include "chain.hpp"

namespace hyst {

// With c = `signal` on entry, one number a sample: `signal` on exit is c' dy/du, by_constants is
// c' dy/dtheta, in the order of jacobian.hpp. Nothing of the size of a Jacobian is stored. state, before
// the record, stays as it is. At a kink the derivative is that of one side, the Jacobian's; where a
// constant rests on a kink and the kind has no rule of its own, that of the step's comparison.
void reverse(const Chain &chain, const double *state, const double *u, std::size_t samples,
             double *signal, double *by_constants);

}  // namespace hyst
