// Loss and gradient of a play bank, kWidth stretches of the record side by side, no Jacobian stored.
//
// Invariant: memories and directions follow the core's play exactly; only the sums over samples may
// be contracted, and are taken lane by lane.
#pragma once

#include "kernels.hpp"
#include "pack.hpp"

namespace hyst::HYST_INSTRUCTION_SET {

// Outputs of kWidth samples of all lanes; memories and directions are written down for the sums.
inline void forward(const GradientBank &bank, const Pack *u, Pack *y) {
    const hyst_pi &pi = bank.pi;
    for (std::size_t t = 0; t < kWidth; ++t) y[t] = pi.p0 * u[t];
    double *written = bank.scratch;
    for (std::size_t i = 0; i < pi.count; ++i) {
        const Pack r = broadcast(pi.r[i]), p = broadcast(pi.p[i]);
        const Pack rose = broadcast(kRose), fell = broadcast(kFell);
        Pack z = load(bank.z + i * kWidth), direction = load(bank.direction + i * kWidth);
#pragma GCC unroll 8
        for (std::size_t t = 0; t < kWidth; ++t) {
            const Pack low = minus(u[t], r), high = plus(u[t], r);
            direction = z < low ? rose : direction;
            direction = z > high ? fell : direction;
            z = clamp(low, high, z);
            y[t] += p * z;
            store(written + t * kWidth, z);
            store(written + (kWidth + t) * kWidth, direction);
        }
        store(bank.z + i * kWidth, z);
        store(bank.direction + i * kWidth, direction);
        written += 2 * kWidth * kWidth;
    }
}

inline void add_sums(const GradientBank &bank, const Pack *error) {
    const double *written = bank.scratch;
    for (std::size_t i = 0; i < bank.pi.count; ++i) {
        Pack by_p = load(bank.by_p + i * kWidth);
        Pack by_direction = load(bank.by_direction + i * kWidth);
#pragma GCC unroll 8
        for (std::size_t t = 0; t < kWidth; ++t) {
            by_p += error[t] * load(written + t * kWidth);
            by_direction += error[t] * load(written + (kWidth + t) * kWidth);
        }
        store(bank.by_p + i * kWidth, by_p);
        store(bank.by_direction + i * kWidth, by_direction);
        written += 2 * kWidth * kWidth;
    }
}

inline double sum_of_lanes(Pack pack) {
    double sum = 0.0;
    for (std::size_t lane = 0; lane < kWidth; ++lane) sum += pack[lane];
    return sum;
}

inline GradientSums gradient_lanes(const GradientBank &bank, const double *u, const double *target,
                                   std::size_t samples, std::size_t stride) {
    Pack squares{}, by_p0{}, sizes{};
    for (std::size_t k = 0; k < samples; k += kWidth) {
        Pack in[kWidth], wanted[kWidth], error[kWidth];
        for (std::size_t c = 0; c < kWidth; ++c) {
            in[c] = load(u + c * stride + k);
            wanted[c] = load(target + c * stride + k);
            __builtin_prefetch(u + c * stride + k + 64);
            __builtin_prefetch(target + c * stride + k + 64);
        }
        transpose(in);
        transpose(wanted);
        forward(bank, in, error);
        for (std::size_t t = 0; t < kWidth; ++t) {
            error[t] -= wanted[t];
            sizes = larger(sizes, magnitude(in[t]));
            squares += error[t] * error[t];
            by_p0 += error[t] * in[t];
        }
        add_sums(bank, error);
    }
    double largest = 0.0;
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
        largest = sizes[lane] > largest ? sizes[lane] : largest;
    }
    return {0.5 * sum_of_lanes(squares), sum_of_lanes(by_p0), largest};
}

}  // namespace hyst::HYST_INSTRUCTION_SET
