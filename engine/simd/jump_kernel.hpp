// Where all plays stand after a stretch of the record, from one backward scan. Why that is exact,
// to the last bit, is proved in docs/engine.md.
//
// Invariant: M and m are the largest low end and the smallest high end of the samples scanned so
// far, from the end of the stretch backwards. Over them, play i maps its memory z to
// clamp(z, M - r_i, m + r_i); once an earlier sample lies beyond one of these bounds the play is
// settled. Thresholds ascend, so the settled plays are always the first ones. Of equal numbers
// (0 and -0) the later sample's is kept.
#pragma once

#include "kernels.hpp"
#include "pack.hpp"
#include "widening_kernel.hpp"

namespace hyst::HYST_INSTRUCTION_SET {

inline double larger_of(double a, double b) { return a > b ? a : b; }
inline double smaller_of(double a, double b) { return a < b ? a : b; }

// Ends of the interval [u - b, u + b] of single samples and of kWidth at once; see lanes_kernel.hpp.
struct PlainSamples {
    const double *u;

    double low(std::size_t k) const { return u[k]; }
    double high(std::size_t k) const { return u[k]; }
    Pack lows(std::size_t k) const { return load(u + k); }
    Pack highs(std::size_t k) const { return load(u + k); }
};

struct RateDependentSamples {
    const hyst_rate_dependent_pi &model;
    const double *u;
    double previous;  // the sample before u[0]

    double b(std::size_t k) const {
        const double change = u[k] - (k > 0 ? u[k - 1] : previous);
        return hyst_widening(&model, change < 0.0 ? -change : change);
    }
    double low(std::size_t k) const { return u[k] - b(k); }
    double high(std::size_t k) const { return u[k] + b(k); }
    Pack bs(std::size_t k) const {
        return widening(model, magnitude(load(u + k) - load(u + k - 1)));
    }
    Pack lows(std::size_t k) const { return load(u + k) - bs(k); }
    Pack highs(std::size_t k) const { return load(u + k) + bs(k); }
};

struct Extremes {
    double M;
    double m;

    template <class Samples>
    Extremes with_block(const Samples &samples, std::size_t first) const {
        Pack high = samples.highs(first), low = samples.lows(first);
        for (std::size_t k = kWidth; k < kJumpBlock; k += kWidth) {
            high = smaller(high, samples.highs(first + k));
            low = larger(low, samples.lows(first + k));
        }
        Extremes both = *this;
        for (std::size_t lane = 0; lane < kWidth; ++lane) {
            both.M = larger_of(low[lane], both.M);
            both.m = smaller_of(high[lane], both.m);
        }
        return both;
    }
};

// z: memories before the stretch in, after it out. direction: the way each play moved last, in and
// out; or null.
template <class Samples>
inline void jump(const Samples &samples, std::size_t count, std::size_t plays, const double *r,
                 double *z, double *direction) {
    if (count == 0) return;
    std::size_t i = 0, k = count - 1;
    Extremes end{samples.low(k), samples.high(k)};
    const auto settle = [&](double value, double towards) {
        z[i] = value;
        if (direction != nullptr) direction[i] = towards;
        ++i;
    };

    while (i < plays && k > 0) {
        // Whole blocks that settle nothing are skipped at the speed of memory.
        while (k > kJumpBlock) {
            const Extremes before = end.with_block(samples, k - kJumpBlock);
            if (before.M - r[i] > before.m + r[i]) break;
            end = before;
            k -= kJumpBlock;
        }
        for (std::size_t stop = k > kJumpBlock ? k - kJumpBlock : 0; k > stop && i < plays;) {
            --k;
            const double low = samples.low(k), high = samples.high(k);
            while (i < plays) {
                if (low - r[i] > end.m + r[i]) {
                    settle(larger_of(end.m + r[i], end.M - r[i]), kFell);
                } else if (high + r[i] < end.M - r[i]) {
                    settle(end.M - r[i], kRose);
                } else {
                    break;
                }
            }
            end.M = larger_of(low, end.M);
            end.m = smaller_of(high, end.m);
        }
    }
    while (i < plays) {
        const double low = end.M - r[i], high = end.m + r[i];
        const double before = z[i];
        const double towards = before > high ? kFell
                               : before < low ? kRose
                               : direction != nullptr ? direction[i] : 0.0;
        settle(larger_of(smaller_of(before, high), low), towards);
    }
}

}  // namespace hyst::HYST_INSTRUCTION_SET
