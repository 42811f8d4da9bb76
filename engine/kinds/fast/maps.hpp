// Maps in double: own derivatives, and whole records by kernels.
#pragma once

#include <cstddef>

#include "../tangents.hpp"

namespace hyst {

// Own columns: gain, offset; weights, thresholds.
void affine_jacobian(const void *map, double dt, const double *state, const Tangents &tangents);
void dead_zone_jacobian(const void *map, double dt, const double *state, const Tangents &tangents);
void direction_dead_zone_jacobian(const void *map, double dt, const double *state,
                                  const Tangents &tangents);

void run_affine(const void *map, double *state, const double *u, double *y, std::size_t samples);
void run_dead_zone(const void *map, double *state, const double *u, double *y, std::size_t samples);

}  // namespace hyst
