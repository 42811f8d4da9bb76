// One Gauss-Newton step towards the drive that makes rate-dependent plays follow a reference.
//
// The cost over the whole record is
//   sum_k (y_k - target_k)^2 + roughness (u_k - 2 u_{k-1} + u_{k-2})^2 + damping step_k^2
//         + penalty (excess of u_k over its range)^2 + penalty (excess of its change)^2
// with y of plays whose corners are rounded: |u_k - u_{k-1}| within `rate` of 0, and contact of a
// play within `contact` of its bounds. Rounded, the cost has a derivative everywhere.
//
// The linearised problem is a linear-quadratic one with the state (z_1..z_n, u_{k-1}, u_{k-2}): one
// Riccati recursion backwards and one sweep forwards solve it exactly, in time and memory
// proportional to the samples, however long a play rests between two contacts.
#pragma once

#include <cstddef>
#include <vector>

#include "hyst/rate_dependent_prandtl_ishlinskii.h"

namespace hyst {

struct Rounding {
    double rate;
    double contact;
};

struct Limits {
    double low, high;  // of u
    double change;     // of |u_k - u_{k-1}|
    double penalty;
};

struct TrajectoryTask {
    const hyst_rate_dependent_pi &model;
    const double *state;  // of the model before the record
    const double *target;
    std::size_t samples;
    double roughness;
    Rounding rounding;
    Limits limits;
};

// The cost at u, without damping.
double trajectory_cost(const TrajectoryTask &task, const double *u);

// Writes the step and returns by how much the linearised cost, without damping, falls.
double trajectory_step(const TrajectoryTask &task, const double *u, double damping, double *step);

}  // namespace hyst
