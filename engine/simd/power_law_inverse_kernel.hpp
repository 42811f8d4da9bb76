// The inverse of a power law along one branch: u = output +- twice f^-1(|share y - start|).
//
// Invariant: each lane takes the steps that solve_power_law of the core takes, operation by
// operation, and as many; a lane that has ended keeps its solution while others go on. So the bits
// are the same.
#pragma once

#include "hyst/loading_curve.h"
#include "power_law_kernel.hpp"

namespace hyst::HYST_INSTRUCTION_SET {

inline Pack halley(double a, Pack s, double e, Pack x, Pack residual) {
    const Pack first = a + e * s;
    const Pack second = e * (e - 1.0) * s / x;
    return 2.0 * residual * first / (2.0 * first * first - residual * second);
}

inline Pack solve_power_law(double a, double b, double e, Pack w) {
    const double enough = 1e-5 / e;
    const Pack by_line = w / a;
    const Pack by_line_power = b * power(by_line, e);
    const Mask line_is_near = by_line_power <= w;
    Pack x = by_line;
    Pack step = halley(a, by_line_power / x, e, x, by_line_power);
    if (any(~line_is_near)) {
        const Pack by_power = power(w / b, 1.0 / e);
        const Pack other = halley(a, w / by_power, e, by_power, a * by_power);
        x = line_is_near ? x : by_power;
        step = line_is_near ? step : other;
    }
    x -= step;
    // Lanes whose start took two powers have one step less.
    Mask left = line_is_near ? Mask{} + (HYST_POWER_LIMIT - 1) : Mask{} + (HYST_POWER_LIMIT - 2);
    for (;;) {
        const Mask goes_on = (left > 0) & (step > enough * x);
        if (!any(goes_on)) return x;
        const Pack s = b * power(x, e - 1.0);
        const Pack next = halley(a, s, e, x, (a + s) * x - w);
        x = goes_on ? x - next : x;
        step = goes_on ? (next < 0.0 ? -next : next) : Pack{};
        left -= 1;
    }
}

inline Pack inverse_power_law(const hyst_power_law &f, Pack w) {
    Pack x;
    if (!(f.factor > 0.0)) {
        x = w / f.linear;
    } else if (!(f.linear > 0.0)) {
        x = power(w / f.factor, 1.0 / f.exponent);
    } else if (f.exponent > 1.0) {
        x = solve_power_law(f.linear, f.factor, f.exponent, w);
    } else {
        x = power(solve_power_law(f.factor, f.linear, 1.0 / f.exponent, w), 1.0 / f.exponent);
    }
    return w > 0.0 ? x : Pack{};
}

inline void inverse_power_law_pack(const hyst_power_law &f, const Branch &branch, const double *u,
                                   double *y) {
    const Pack along = branch.share * load(u) - branch.start;
    const Pack way = branch.twice * inverse_power_law(f, along < 0.0 ? -along : along);
    store(y, along < 0.0 ? branch.output - way : branch.output + way);
}

inline void inverse_power_law_branch(const hyst_power_law &f, const Branch &branch,
                                     const double *u, double *y, std::size_t samples) {
    std::size_t k = 0;
    for (; k + kWidth <= samples; k += kWidth) inverse_power_law_pack(f, branch, u + k, y + k);
    if (k == samples) return;
    double rest[kWidth];
    // Lanes without a sample do as the last one, or they might take more steps.
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
        rest[lane] = u[k + lane < samples ? k + lane : samples - 1];
    }
    inverse_power_law_pack(f, branch, rest, rest);
    for (std::size_t lane = 0; lane < samples - k; ++lane) y[k + lane] = rest[lane];
}

}  // namespace hyst::HYST_INSTRUCTION_SET
