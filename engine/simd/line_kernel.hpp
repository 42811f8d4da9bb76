// Straight stretches of the memory curve: while the input moves one way and pushes no further play,
// the output is a + b u.
//
// Invariant: a sample is taken only if it is not behind the one before it and not beyond the limit;
// as the limit is finite, infinities and NaNs end a stretch.
#pragma once

#include "kernels.hpp"
#include "pack.hpp"

namespace hyst::HYST_INSTRUCTION_SET {

template <bool rising>
inline bool stays(const Line &line, double before, double now) {
    return rising ? now >= before && now <= line.limit : now <= before && now >= line.limit;
}

template <bool rising>
inline std::size_t follow(const Line &line, const double *u, double *y, std::size_t count) {
    // Rough records leave the line at once; packs pay from the fifth sample on.
    constexpr std::size_t probe = 4;
    std::size_t k = 0;
    for (; k < count && k < probe; ++k) {
        if (!stays<rising>(line, (u + k)[-1], u[k])) return k;
        y[k] = line.a + line.b * u[k];
    }
    const Pack a = broadcast(line.a), b = broadcast(line.b), limit = broadcast(line.limit);
    for (; k + kWidth <= count; k += kWidth) {
        const Pack now = load(u + k), before = load(u + k - 1);
        const Mask leaves = rising ? (now < before) | (now > limit) | (now != now)
                                   : (now > before) | (now < limit) | (now != now);
        if (any(leaves)) break;
        store(y + k, a + b * now);
    }
    for (; k < count && stays<rising>(line, (u + k)[-1], u[k]); ++k) y[k] = line.a + line.b * u[k];
    return k;
}

}  // namespace hyst::HYST_INSTRUCTION_SET
