// hyst_widening of the core for a pack of rates, with the core's bits.
#pragma once

#include "hyst/rate_dependent_prandtl_ishlinskii.h"
#include "memoryless_kernel.hpp"
#include "pack.hpp"

namespace hyst::HYST_INSTRUCTION_SET {

inline Pack widening(const hyst_rate_dependent_pi &model, Pack x) {
    Pack slope{};
    for (std::size_t i = model.powers; i > 0; --i) slope = (slope + model.power[i - 1]) * x;
    return larger((slope + model.growth) * x + dead_zone_pack(model.ramps, x), Pack{});
}

}  // namespace hyst::HYST_INSTRUCTION_SET
