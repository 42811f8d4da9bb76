// The derivative of a kind of stage from its output back to its input and its constants, by the kernel:
// the core's step, compiled with a number that records what it does. What a sample costs does not
// depend on how many constants there are, or how many samples.
#pragma once

#include "../kinds/cotangents.hpp"
#include "derivative.hpp"

namespace hyst {

// length: of the stage's state.
void kernel_reverse(const Said &said, std::size_t length, const Cotangents &given);

}  // namespace hyst
