// Rows of play outputs and of their derivatives, one row a sample. Here the plays are side by side.
#pragma once

#include "hyst/play.h"
#include "kernels.hpp"
#include "pack.hpp"

namespace hyst::HYST_INSTRUCTION_SET {

inline void derivative_rows(const hyst_pi &pi, double *z, double *direction, const double *u,
                            std::size_t samples, double *by_p, double *by_r, std::size_t stride) {
    for (std::size_t k = 0; k < samples; ++k, by_p += stride, by_r += stride) {
        std::size_t i = 0;
        for (; i + kWidth <= pi.count; i += kWidth) {
            const Pack r = load(pi.r + i), before = load(z + i);
            const Pack now = clamp(u[k] - r, u[k] + r, before);
            Pack towards = load(direction + i);
            towards = now > before ? broadcast(kRose) : towards;
            towards = now < before ? broadcast(kFell) : towards;
            store(z + i, now);
            store(direction + i, towards);
            store(by_p + i, now);
            store(by_r + i, load(pi.p + i) * towards);
        }
        for (; i < pi.count; ++i) {
            const double before = z[i];
            z[i] = hyst_play(u[k], pi.r[i], before);
            if (z[i] > before) direction[i] = kRose;
            if (z[i] < before) direction[i] = kFell;
            by_p[i] = z[i];
            by_r[i] = pi.p[i] * direction[i];
        }
    }
}

inline void play_rows(const double *r, double *z, std::size_t stride, const double *u,
                      std::size_t samples, double *rows) {
    for (std::size_t i = 0; i < stride; i += kWidth) {
        const Pack threshold = load(r + i);
        Pack memory = load(z + i);
        for (std::size_t k = 0; k < samples; ++k) {
            memory = clamp(u[k] - threshold, u[k] + threshold, memory);
            store(rows + k * stride + i, memory);
        }
        store(z + i, memory);
    }
}

}  // namespace hyst::HYST_INSTRUCTION_SET
