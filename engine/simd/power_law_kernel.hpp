// A power law along one branch of a loading curve: y = output +- twice f(|share u - start|).
//
// Invariant: power does to each lane what hyst_power of the core does, operation by operation, so
// that the bits are the same.
#pragma once

#include "hyst/power.h"
#include "kernels.hpp"
#include "pack.hpp"

namespace hyst::HYST_INSTRUCTION_SET {

using Whole = int __attribute__((vector_size(kWidth * sizeof(int))));

inline Pack log2(Pack x) {
    const Mask is_small = x < HYST_LEAST_NORMAL;
    const Pack offset = is_small ? broadcast(HYST_EXPONENT_BIAS + HYST_SCALE_UP_EXPONENT)
                                 : broadcast(HYST_EXPONENT_BIAS);
    const Pack normal = is_small ? x * HYST_SCALE_UP : x;
    constexpr auto one = static_cast<long long>(HYST_ONE_BITS);
    constexpr auto root_half = static_cast<long long>(HYST_ROOT_HALF_BITS);
    constexpr long long mantissa = (1LL << HYST_MANTISSA_BITS) - 1;
    const Mask shifted = reinterpret_cast<Mask>(normal) + (one - root_half);
    const Pack m = reinterpret_cast<Pack>((shifted & mantissa) + root_half);
    const Pack whole = reinterpret_cast<Pack>((shifted >> HYST_MANTISSA_BITS) |
                                              static_cast<long long>(HYST_UNIT_BITS));
    const Pack k = (whole - HYST_UNIT) - offset;
    const Pack t = (m - 1.0) / (m + 1.0);
    const Pack s = t * t, s2 = s * s;
    const Pack even =
        0.3333333333333333 +
        s2 * (0.14285714285714285 +
              s2 * (0.09090909090909091 + s2 * (0.06666666666666667 + s2 * 0.05263157894736842)));
    const Pack odd =
        0.2 + s2 * (0.1111111111111111 +
                    s2 * (0.07692307692307693 +
                          s2 * (0.058823529411764705 + s2 * 0.047619047619047616)));
    const Pack artanh = t + t * (s * (even + s * odd));
    return k + 2.8853900817779268 * artanh;
}

inline Pack exp2(Pack v) {
    const Pack most = broadcast(HYST_EXPONENT_BIAS + 5);
    const Pack least = broadcast(-(HYST_EXPONENT_BIAS + HYST_MANTISSA_BITS + 5));
    v = v < most ? v : most;
    v = v > least ? v : least;
    const Pack rounded = v + (v < 0.0 ? broadcast(-0.5) : broadcast(0.5));
    const Whole n = __builtin_convertvector(rounded, Whole);
    const Pack z = 0.6931471805599453 * (v - __builtin_convertvector(n, Pack));
    const Pack z2 = z * z;
    const Pack even =
        0.5 +
        z2 * (0.041666666666666664 +
              z2 * (0.001388888888888889 +
                    z2 * (2.48015873015873e-05 +
                          z2 * (2.755731922398589e-07 + z2 * 2.08767569878681e-09))));
    const Pack odd =
        0.16666666666666666 +
        z2 * (0.008333333333333333 +
              z2 * (0.0001984126984126984 +
                    z2 * (2.7557319223985893e-06 +
                          z2 * (2.505210838544172e-08 + z2 * 1.6059043836821613e-10))));
    const Pack exponential = 1.0 + (z + z2 * (even + z * odd));
    const Mask first = __builtin_convertvector(n / 2, Mask);
    const Mask second = __builtin_convertvector(n - n / 2, Mask);
    const Pack half =
        reinterpret_cast<Pack>((first + HYST_EXPONENT_BIAS) << HYST_MANTISSA_BITS);
    const Pack rest =
        reinterpret_cast<Pack>((second + HYST_EXPONENT_BIAS) << HYST_MANTISSA_BITS);
    return exponential * half * rest;
}

inline Pack power(Pack x, double e) {
    const Pack result = exp2(e * log2(x));
    return x > 0.0 ? result : Pack{};
}

inline void power_law_pack(const hyst_power_law &f, const Branch &branch, const double *u,
                           double *y) {
    const Pack along = branch.share * load(u) - branch.start;
    const Pack x = along < 0.0 ? -along : along;
    const Pack way = branch.twice * (f.linear * x + f.factor * power(x, f.exponent));
    store(y, along < 0.0 ? branch.output - way : branch.output + way);
}

inline void power_law_branch(const hyst_power_law &f, const Branch &branch, const double *u,
                             double *y, std::size_t samples) {
    std::size_t k = 0;
    for (; k + kWidth <= samples; k += kWidth) power_law_pack(f, branch, u + k, y + k);
    if (k == samples) return;
    double rest[kWidth] = {};
    for (std::size_t lane = 0; lane < samples - k; ++lane) rest[lane] = u[k + lane];
    power_law_pack(f, branch, rest, rest);
    for (std::size_t lane = 0; lane < samples - k; ++lane) y[k + lane] = rest[lane];
}

}  // namespace hyst::HYST_INSTRUCTION_SET
