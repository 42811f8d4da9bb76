// Loading curves with memory of reversals in double: own derivative, and records stretch by stretch.
#pragma once

#include <cstddef>

#include "../tangents.hpp"

namespace hyst {

// Own columns: c1 c2 c3 of a power law; p0, p, r of plays; a_1 .. a_n of a polynomial.
void masing_jacobian(const void *model, double dt, const double *state, const Tangents &tangents);

// Bit for bit what the core's step does sample by sample.
void run_masing(const void *model, double *state, const double *u, double *y, std::size_t samples);

}  // namespace hyst
