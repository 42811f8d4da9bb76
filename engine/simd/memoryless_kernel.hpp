// Maps without memory, several samples at once, with the bits of the core's steps.
#pragma once

#include "hyst/dead_zone.h"
#include "pack.hpp"

namespace hyst::HYST_INSTRUCTION_SET {

inline std::size_t first_non_finite(const double *u, std::size_t count) {
    constexpr std::size_t block = 4 * kWidth;
    const auto bad = [](double value) { return !(value - value == 0.0); };
    std::size_t k = 0;
    for (; k + block <= count; k += block) {
        // A number times zero is zero, an infinity or a NaN times zero is NaN and stays in the sum.
        Pack sum{};
#pragma GCC unroll 4
        for (std::size_t j = 0; j < block; j += kWidth) sum += 0.0 * load(u + k + j);
        if (any(sum != 0.0)) break;
    }
    while (k < count && !bad(u[k])) ++k;
    return k;
}

inline void affine(double gain, double offset, const double *u, double *y, std::size_t count) {
    std::size_t k = 0;
    for (; k + kWidth <= count; k += kWidth) store(y + k, gain * load(u + k) + offset);
    for (; k < count; ++k) y[k] = gain * u[k] + offset;
}

inline Pack dead_zone_term(Pack u, double rho) {
    const Pack excess = u - rho, zero{};
    if (rho > 0.0) return larger(excess, zero);
    if (rho < 0.0) return smaller(excess, zero);
    return u;
}

inline Pack dead_zone_pack(const hyst_dead_zone &map, Pack u) {
    Pack y{};
    for (std::size_t i = 0; i < map.count; ++i) {
        y += map.weight[i] * dead_zone_term(u, map.threshold[i]);
    }
    return y;
}

inline void dead_zone(const hyst_dead_zone &map, const double *u, double *y, std::size_t count) {
    std::size_t k = 0;
    for (; k + kWidth <= count; k += kWidth) store(y + k, dead_zone_pack(map, load(u + k)));
    if (k < count) {
        double rest[kWidth] = {};
        const std::size_t left = count - k;
        __builtin_memcpy(rest, u + k, left * sizeof(double));
        store(rest, dead_zone_pack(map, load(rest)));
        __builtin_memcpy(y + k, rest, left * sizeof(double));
    }
}

}  // namespace hyst::HYST_INSTRUCTION_SET
