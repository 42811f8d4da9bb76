// Creep and first-order lags in double: whole records with the core's bits.
#pragma once

#include <cstddef>

namespace hyst {

// The same operations in the same order as hyst_creep_step and hyst_lag_step, so the same bits.
void run_creep(const void *creep, double *state, const double *u, double *y, std::size_t samples);
void run_lag(const void *lag, double *state, const double *u, double *y, std::size_t samples);

}  // namespace hyst
