// Plays in double: own derivatives, and time lanes.
#pragma once

#include <cstddef>

#include "../kind.hpp"

namespace hyst {

// Own columns: r; p0, p, r; and beta, powers and slopes of the ramps.
void play_jacobian(const void *r, double dt, const double *state, const Tangents &tangents);
void stop_jacobian(const void *r, double dt, const double *state, const Tangents &tangents);
void pi_jacobian(const void *bank, double dt, const double *state, const Tangents &tangents);
void rate_dependent_pi_jacobian(const void *model, double dt, const double *state,
                                const Tangents &tangents);

// From the output back.
void play_reverse(const void *r, const Cotangents &given);
void stop_reverse(const void *r, const Cotangents &given);
void pi_reverse(const void *bank, const Cotangents &given);

extern const HYST_KINDS::Plays lanes_of_play, lanes_of_stop, lanes_of_pi, lanes_of_rate_dependent_pi;

}  // namespace hyst
