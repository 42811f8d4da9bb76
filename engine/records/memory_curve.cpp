#include "memory_curve.hpp"

#include <algorithm>
#include <cmath>

namespace hyst {

bool is_admissible(const hyst_pi &pi, const double *z) {
    constexpr double rounding = 8.0 * std::numeric_limits<double>::epsilon();
    for (std::size_t i = 0; i + 1 < pi.count; ++i) {
        const double size = std::abs(z[i]) + std::abs(z[i + 1]) + pi.r[i + 1];
        const double reach = pi.r[i + 1] - pi.r[i] + rounding * size;
        if (!(std::abs(z[i + 1] - z[i]) <= reach)) return false;
    }
    return true;
}

double headroom(const hyst_pi &pi, const double *z, double limit) {
    double weights = 0.0, start = 0.0;
    for (std::size_t i = 0; i < pi.count; ++i) {
        weights += std::abs(pi.p[i]);
        start = std::max(start, std::abs(z[i]));
    }
    // A play is never further from 0 than at the start or than the input has been.
    const double held = weights * (start + pi.r[pi.count - 1]);
    const double room = (limit - held) / (std::abs(pi.p0) + weights);
    return std::min(room, limit);  // in this order a NaN stays one
}

MemoryCurve::MemoryCurve(const hyst_pi &pi, const double *z)
    : p_sum_(pi.count + 1),
      pr_sum_(pi.count + 1),
      start_sum_(pi.count + 1),
      first_in_cell_(2 * pi.count + 1),
      stack_(pi.count + 2) {
    for (std::size_t i = 0; i < pi.count; ++i) {
        p_sum_[i + 1] = p_sum_[i] + pi.p[i];
        pr_sum_[i + 1] = pr_sum_[i] + pi.p[i] * pi.r[i];
    }
    for (std::size_t i = pi.count; i-- > 0;) start_sum_[i] = start_sum_[i + 1] + pi.p[i] * z[i];
    data_ = {&pi,  z, p_sum_.data(), pr_sum_.data(), start_sum_.data(), first_in_cell_.data(),
             0.0, stack_.data(), 0, 0.0};
    build_index(pi);
}

// Cells of equal width over the thresholds, twice as many as plays: evenly spread plays are found
// in one look, any others by bisection.
void MemoryCurve::build_index(const hyst_pi &pi) {
    const double largest = pi.r[pi.count - 1];
    const std::size_t cells = 2 * pi.count;
    const double per_unit = largest > 0.0 ? static_cast<double>(cells) / largest : 0.0;
    data_.cells_per_unit = std::isfinite(per_unit) ? per_unit : 0.0;
    std::size_t i = 0;
    for (std::size_t cell = 0; cell <= cells; ++cell) {
        while (i < pi.count && pi.r[i] * data_.cells_per_unit < static_cast<double>(cell)) ++i;
        first_in_cell_[cell] = i;
    }
}

}  // namespace hyst
