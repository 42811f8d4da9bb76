// Straight stretches of the memory curve: while the input moves one way and pushes no further play,
// the output is a + b u.
//
// Invariant: a sample is taken only if it is not behind the one before it and not beyond the limit.
// So a NaN ends a stretch, and nothing but infinities follows an infinity.
#pragma once

#include "kernels.hpp"
#include "pack.hpp"

namespace hyst::HYST_INSTRUCTION_SET {

template <bool rising, class Number>
inline auto stays(const Number &before, const Number &now, const Number &limit) {
    return rising ? (now >= before) & (now <= limit) : (now <= before) & (now >= limit);
}

// A pack is written whole, also where the line ends inside it: what is too much is written again by
// whoever goes on from there.
template <bool rising>
inline std::size_t follow(const Line &line, const double *u, double *y, std::size_t count) {
    // Rough records leave the line at once; there a branch that is predicted beats a pack.
    constexpr std::size_t probe = 4;
    std::size_t k = 0;
    for (; k < count && k < probe; ++k) {
        if (!stays<rising>((u + k)[-1], u[k], line.limit)) return k;
        y[k] = line.a + line.b * u[k];
    }
    constexpr unsigned all = (1u << kWidth) - 1;
    const Pack a = broadcast(line.a), b = broadcast(line.b), limit = broadcast(line.limit);
    for (; k + kWidth <= count; k += kWidth) {
        const Pack now = load(u + k);
        const unsigned on_line = bits(stays<rising>(load(u + k - 1), now, limit));
        store(y + k, a + b * now);
        if (on_line != all) return k + static_cast<std::size_t>(__builtin_ctz(~on_line));
    }
    for (; k < count && stays<rising>((u + k)[-1], u[k], line.limit); ++k) {
        y[k] = line.a + line.b * u[k];
    }
    return k;
}

}  // namespace hyst::HYST_INSTRUCTION_SET
