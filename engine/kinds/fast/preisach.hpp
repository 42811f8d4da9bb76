// The Preisach operator in double: records piece by piece, and its derivative.
#pragma once

#include <cstddef>

#include "../tangents.hpp"

namespace hyst {

// Bit for bit what the core's step does sample by sample.
void run_preisach(const void *model, double *state, const double *u, double *y, std::size_t samples);

void preisach_jacobian(const void *model, double dt, const double *state, const Tangents &tangents);

}  // namespace hyst
