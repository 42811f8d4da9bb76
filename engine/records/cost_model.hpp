// Which engine is fastest for a stage, from a look at a few samples of its input.
// The constants are fits to measurements; docs/engine.md has the table they come from.
#pragma once

#include <cstddef>

#include "hyst/prandtl_ishlinskii.h"

namespace hyst {

enum class Engine { automatic, loop, lanes, memory_curve };

const char *name_of(Engine engine);

// What the cost of the memory curve depends on, per sample: turning points, and plays newly pushed.
struct Roughness {
    double reversals = 0.0;
    double pushes = 0.0;
};

Roughness roughness(const hyst_pi &pi, const double *u, std::size_t samples);

// Expected nanoseconds for a whole record of `samples` through `plays` plays.
double cost_of_loop(std::size_t plays, std::size_t samples);
double cost_of_lanes(std::size_t plays, std::size_t samples);
double cost_of_memory_curve(std::size_t plays, std::size_t samples, const Roughness &roughness);

}  // namespace hyst
