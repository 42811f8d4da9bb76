// Records through a state space: the core's loop, unrolled for small orders.
#pragma once

#include <cstddef>

#include "hyst/hyst.h"

namespace hyst {

// The same operations in the same order as hyst_state_space_step, so the same bits.
void run_state_space(const hyst_state_space &system, double *state, const double *u, double *y,
                     std::size_t samples);

}  // namespace hyst
