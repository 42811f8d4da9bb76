// Records through a loading curve with memory of reversals: between two events, stretch by stretch.
#pragma once

#include <cstddef>

#include "hyst/hyst.h"

namespace hyst {

// Bit for bit what the core's step does sample by sample. u and y may be the same.
void run_masing(const hyst_masing &model, double *state, const double *u, double *y,
                std::size_t samples);

}  // namespace hyst
