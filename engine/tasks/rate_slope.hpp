// The slope of the curve by which thresholds widen with the rate.
#pragma once

#include <cstddef>

#include "hyst/rate_dependent_prandtl_ishlinskii.h"

namespace hyst {

inline double slope_of_widening(const hyst_rate_dependent_pi &model, double x) {
    double slope = model.growth, power = x;
    for (std::size_t m = 0; m < model.powers; ++m, power *= x) {
        slope += static_cast<double>(m + 2) * model.power[m] * power;
    }
    for (std::size_t j = 0; j < model.ramps.count; ++j) {
        if (x > model.ramps.threshold[j]) slope += model.ramps.weight[j];
    }
    return slope;
}

}  // namespace hyst
