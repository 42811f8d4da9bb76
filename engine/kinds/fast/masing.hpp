// Loading curves with memory of reversals in double: records stretch by stretch.
#pragma once

#include <cstddef>

namespace hyst {

// Bit for bit what the core's step does sample by sample.
void run_masing(const void *model, double *state, const double *u, double *y, std::size_t samples);

}  // namespace hyst
