#include "cost_model.hpp"

#include <algorithm>
#include <cmath>

#include "../simd/kernels.hpp"

namespace hyst {

const char *name_of(Engine engine) {
    switch (engine) {
    case Engine::automatic:
        return "auto";
    case Engine::loop:
        return "loop";
    case Engine::lanes:
        return "lanes";
    case Engine::memory_curve:
        return "memory-curve";
    }
    return "";
}

Roughness roughness(const hyst_pi &pi, const double *u, std::size_t samples) {
    constexpr std::size_t windows = 16, window = 64;
    const std::size_t stride = std::max(samples / windows, window);
    double travelled = 0.0;
    std::size_t steps = 0, turns = 0;
    for (std::size_t first = 0; first + 1 < samples; first += stride) {
        double way = 0.0;
        for (std::size_t k = first + 1; k < std::min(first + window, samples); ++k, ++steps) {
            const double change = u[k] - u[k - 1];
            if (change * way < 0.0) ++turns;
            if (change != 0.0) way = change;
            travelled += std::abs(change);
        }
    }
    if (steps == 0) return {};
    const double largest = pi.r[pi.count - 1], count = static_cast<double>(pi.count);
    const double mean_change = travelled / static_cast<double>(steps);
    // Thresholds taken as evenly spread: a change d passes those up to d / 2.
    const double pushes = largest > 0.0 ? 0.5 * mean_change * count / largest : 0.0;
    return {static_cast<double>(turns) / static_cast<double>(steps), pushes};
}

double cost_of_loop(std::size_t plays, std::size_t samples) {
    return static_cast<double>(samples) * std::max(3.5, 0.6 * static_cast<double>(plays));
}

double cost_of_lanes(std::size_t plays, std::size_t samples) {
    const double width = static_cast<double>(kernels().width), count = static_cast<double>(plays);
    const double to_start = 300.0 + 4.0 * width * count;
    return to_start + static_cast<double>(samples) * (0.15 + 0.6 / width * (1.0 + count));
}

double cost_of_memory_curve(std::size_t plays, std::size_t samples, const Roughness &rough) {
    const double to_start = 300.0 + 15.0 * static_cast<double>(plays);
    const double a_sample = 0.25 + 30.0 * rough.reversals + 6.0 * std::min(rough.pushes, 0.8);
    return to_start + static_cast<double>(samples) * a_sample;
}

}  // namespace hyst
