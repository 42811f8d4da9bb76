// Linear dynamics in double: own derivatives, and a state space unrolled for small orders.
#pragma once

#include <cstddef>

#include "../tangents.hpp"

namespace hyst {

// Own columns: A row after row, B, C, D. The initial state does not depend on any of them.
void state_space_jacobian(const void *system, double dt, const double *state,
                          const Tangents &tangents);

// Own columns: b0 b1 b2 a1 a2 of each section.
void sections_jacobian(const void *sections, double dt, const double *state,
                       const Tangents &tangents);

// The same operations in the same order as hyst_state_space_step, so the same bits.
void run_state_space(const void *system, double *state, const double *u, double *y,
                     std::size_t samples);

}  // namespace hyst
