// kWidth records side by side, one in each lane, through the same bank of plays.
//
// Invariant: every lane does the operations of hyst_pi_step (or its rate-dependent sibling) in the
// order of hyst/bank.h, none of them contracted, so z and y get the core's bits.
#pragma once

#include "hyst/bank.h"
#include "pack.hpp"
#include "widening_kernel.hpp"

namespace hyst::HYST_INSTRUCTION_SET {

// The interval [u - b, u + b] that a threshold r widens to the play's bounds: b = 0 for a play of
// constant threshold, b = g(|u - u_previous|) for a rate-dependent one. `prepare` sees kWidth
// samples of all lanes, `low` and `high` give their intervals.
struct ConstantThreshold {
    void prepare(const Pack *) {}
    Pack low(std::size_t t, const Pack *u) const { return u[t]; }
    Pack high(std::size_t t, const Pack *u) const { return u[t]; }
};

struct RateDependentThreshold {
    const hyst_rate_dependent_pi &model;
    Pack previous;  // last inputs of the lanes
    Pack low_[kWidth], high_[kWidth];

    RateDependentThreshold(const hyst_rate_dependent_pi &of, Pack before)
        : model(of), previous(before) {}

    void prepare(const Pack *u) {
        for (std::size_t t = 0; t < kWidth; ++t) {
            const Pack b = widening(model, magnitude(u[t] - previous));
            low_[t] = u[t] - b;
            high_[t] = u[t] + b;
            previous = u[t];
        }
    }
    Pack low(std::size_t t, const Pack *) const { return low_[t]; }
    Pack high(std::size_t t, const Pack *) const { return high_[t]; }
};

// `together` plays from the i-th on, through kWidth samples of all lanes. Their products are added to
// sums that lie `apart` packs apart, the first of them at `sum`: all to one where that is 0.
template <std::size_t together, std::size_t apart, class Threshold>
inline void pass_plays(const hyst_pi &pi, std::size_t i, const Threshold &threshold, const Pack *u,
                       Pack *sum, double *z) {
    Pack r[together], p[together], memory[together];
#pragma GCC unroll 2
    for (std::size_t a = 0; a < together; ++a) {
        r[a] = broadcast(pi.r[i + a]);
        p[a] = broadcast(pi.p[i + a]);
        memory[a] = load(z + (i + a) * kWidth);
    }
#pragma GCC unroll 8
    for (std::size_t t = 0; t < kWidth; ++t) {
        const Pack low = threshold.low(t, u), high = threshold.high(t, u);
#pragma GCC unroll 2
        for (std::size_t a = 0; a < together; ++a) {
            memory[a] = clamp(minus(low, r[a]), plus(high, r[a]), memory[a]);
            sum[a * apart + t] += p[a] * memory[a];
        }
    }
#pragma GCC unroll 2
    for (std::size_t a = 0; a < together; ++a) store(z + (i + a) * kWidth, memory[a]);
}

// What the first `fours` plays of a wide bank add to y: two of their four sums at a time, or they would
// not stay in registers. A function of its own, or narrow banks would have fewer of them.
template <class Threshold>
[[gnu::noinline]] void add_fours(const hyst_pi &pi, std::size_t fours, const Threshold &threshold,
                                 const Pack *u, Pack *y, double *z) {
    Pack s01[2 * kWidth] = {}, s23[2 * kWidth] = {};
    for (std::size_t i = 0; i < fours; i += 4) pass_plays<2, kWidth>(pi, i, threshold, u, s01, z);
    for (std::size_t i = 2; i < fours; i += 4) pass_plays<2, kWidth>(pi, i, threshold, u, s23, z);
#pragma GCC unroll 8
    for (std::size_t t = 0; t < kWidth; ++t) {
        y[t] += (s01[t] + s23[t]) + (s01[kWidth + t] + s23[kWidth + t]);
    }
}

// kWidth samples of all lanes. u: in time order; y: out. z: count packs, one for each play.
template <class Threshold>
inline void square(const hyst_pi &pi, Threshold &threshold, const Pack *u, Pack *y, double *z) {
    threshold.prepare(u);
    const Pack p0 = broadcast(pi.p0);
#pragma GCC unroll 8
    for (std::size_t t = 0; t < kWidth; ++t) y[t] = p0 * u[t];
    std::size_t i = pi.count < HYST_WIDE_BANK ? 0 : pi.count - pi.count % 4;
    if (i > 0) add_fours(pi, i, threshold, u, y, z);
    // Two at a time: the min and the max of one play wait for each other, those of two do not.
    for (; i + 2 <= pi.count; i += 2) pass_plays<2, 0>(pi, i, threshold, u, y, z);
    if (i < pi.count) pass_plays<1, 0>(pi, i, threshold, u, y, z);
}

template <class Threshold>
struct PlayBank {
    const hyst_pi &pi;
    Threshold threshold;
    double *z;

    void operator()(const Pack *u, Pack *y) { square(pi, threshold, u, y, z); }
};

struct SinglePlay {
    Pack r;
    bool stop;
    Pack z;

    void operator()(const Pack *u, Pack *y) {
        for (std::size_t t = 0; t < kWidth; ++t) {
            z = clamp(u[t] - r, u[t] + r, z);
            y[t] = stop ? u[t] - z : z;
        }
    }
};

// Lane c reads u[c * stride ..) and writes y[c * stride ..), `samples` each, a multiple of kWidth.
// Returns whether all of both were finite.
template <class Stage>
inline bool lanes(Stage &stage, const double *u, double *y, std::size_t samples,
                  std::size_t stride) {
    // As many streams as lanes, each way: more than processors follow by themselves.
    constexpr std::size_t ahead = 64;
    // 0 times a number is 0, 0 times an infinity or a NaN is NaN and stays in the sum.
    Pack zeros{}, zeros_out{};
    for (std::size_t k = 0; k < samples; k += kWidth) {
        Pack in[kWidth], out[kWidth];
#pragma GCC unroll 8
        for (std::size_t c = 0; c < kWidth; ++c) {
            in[c] = load(u + c * stride + k);
            zeros += 0.0 * in[c];
            __builtin_prefetch(u + c * stride + k + ahead);
            __builtin_prefetch(y + c * stride + k + ahead, 1);
        }
        transpose(in);
        stage(in, out);
        transpose(out);
#pragma GCC unroll 8
        for (std::size_t c = 0; c < kWidth; ++c) {
            store(y + c * stride + k, out[c]);
            zeros_out += 0.0 * out[c];
        }
    }
    return !any(zeros + zeros_out != 0.0);
}

}  // namespace hyst::HYST_INSTRUCTION_SET
