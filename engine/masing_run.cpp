// The core's step decides at every event: a reversal, a loop that closes, a rest. While the input
// goes one way inside a loop nothing is decided, and all samples of the stretch are points of one
// branch, which packs of them are evaluated for at once.
//
// Invariant: power_pack does to each lane what hyst_power of the core does, operation by operation,
// so that the bits are the same; tests compare them.
#include "masing_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

// Packs are passed between functions that are always inlined, so that no ABI is concerned.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace hyst {
namespace {

constexpr std::size_t kLanes = 4;
using Pack = double __attribute__((vector_size(kLanes * sizeof(double))));
using Bits = std::int64_t __attribute__((vector_size(kLanes * sizeof(double))));
using Whole = std::int32_t __attribute__((vector_size(kLanes * sizeof(std::int32_t))));

#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__)
#define HYST_FOR_EVERY_PROCESSOR __attribute__((target_clones("avx2", "default")))
#else
#define HYST_FOR_EVERY_PROCESSOR
#endif

#define HYST_INLINE inline __attribute__((always_inline))

HYST_INLINE Pack log2_pack(Pack x) {
    const Bits is_small = x < HYST_LEAST_NORMAL;
    const Pack offset = is_small ? Pack{} + (HYST_EXPONENT_BIAS + HYST_SCALE_UP_EXPONENT)
                                 : Pack{} + HYST_EXPONENT_BIAS;
    const Pack normal = is_small ? x * HYST_SCALE_UP : x;
    constexpr auto one = static_cast<std::int64_t>(HYST_ONE_BITS);
    constexpr auto root_half = static_cast<std::int64_t>(HYST_ROOT_HALF_BITS);
    constexpr std::int64_t mantissa = (std::int64_t{1} << HYST_MANTISSA_BITS) - 1;
    const Bits shifted = reinterpret_cast<Bits>(normal) + (one - root_half);
    const Pack m = reinterpret_cast<Pack>((shifted & mantissa) + root_half);
    const Pack whole = reinterpret_cast<Pack>((shifted >> HYST_MANTISSA_BITS) |
                                              static_cast<std::int64_t>(HYST_UNIT_BITS));
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

HYST_INLINE Pack exp2_pack(Pack v) {
    const Pack most = Pack{} + (HYST_EXPONENT_BIAS + 5);
    const Pack least = Pack{} - (HYST_EXPONENT_BIAS + HYST_MANTISSA_BITS + 5);
    v = v < most ? v : most;
    v = v > least ? v : least;
    const Pack rounded = v + (v < 0.0 ? Pack{} - 0.5 : Pack{} + 0.5);
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
    const Bits first = __builtin_convertvector(n / 2, Bits);
    const Bits second = __builtin_convertvector(n - n / 2, Bits);
    const Pack half =
        reinterpret_cast<Pack>((first + HYST_EXPONENT_BIAS) << HYST_MANTISSA_BITS);
    const Pack rest =
        reinterpret_cast<Pack>((second + HYST_EXPONENT_BIAS) << HYST_MANTISSA_BITS);
    return exponential * half * rest;
}

HYST_INLINE Pack power_pack(Pack x, double e) {
    const Pack result = exp2_pack(e * log2_pack(x));
    return x > 0.0 ? result : Pack{};
}

// One branch: y = output +- twice f(|share u - start|).
struct Branch {
    double share, start, output, twice;
};

Branch branch_of(const hyst_masing &model, const double *state) {
    const std::size_t count = hyst_masing_reversals(&model, state);
    if (count == 0) return {1.0, 0.0, 0.0, 1.0};
    const double *top = state + HYST_MASING_STACK + 2 * (count - 1);
    return {0.5, 0.5 * top[0], top[1], 2.0};
}

HYST_INLINE void power_law_pack(const hyst_power_law &f, const Branch &branch, const double *u,
                                double *y) {
    Pack input;
    __builtin_memcpy(&input, u, sizeof input);
    const Pack along = branch.share * input - branch.start;
    const Pack x = along < 0.0 ? -along : along;
    const Pack way = branch.twice * (f.linear * x + f.factor * power_pack(x, f.exponent));
    const Pack output = along < 0.0 ? branch.output - way : branch.output + way;
    __builtin_memcpy(y, &output, sizeof output);
}

HYST_FOR_EVERY_PROCESSOR
void power_law_stretch(const hyst_power_law &f, const Branch &branch, const double *u, double *y,
                       std::size_t samples) {
    std::size_t k = 0;
    for (; k + kLanes <= samples; k += kLanes) power_law_pack(f, branch, u + k, y + k);
    if (k == samples) return;
    double rest[kLanes] = {};
    for (std::size_t lane = 0; lane < samples - k; ++lane) rest[lane] = u[k + lane];
    power_law_pack(f, branch, rest, rest);
    for (std::size_t lane = 0; lane < samples - k; ++lane) y[k + lane] = rest[lane];
}

void stretch(const hyst_masing &model, const Branch &branch, const double *u, double *y,
             std::size_t samples) {
    if (model.curve.kind == HYST_POWER_LAW && !model.inverse) {
        power_law_stretch(model.curve.as.power_law, branch, u, y, samples);
        return;
    }
    for (std::size_t k = 0; k < samples; ++k) {
        const double along = branch.share * u[k] - branch.start;
        const double way = branch.twice * hyst_masing_curve(&model, std::abs(along));
        y[k] = along < 0.0 ? branch.output - way : branch.output + way;
    }
}

// Where the branch ends: input and output of the reversal at which its loop closes.
struct End {
    double input, output;
};

End end_of(const hyst_masing &model, const double *state, bool rising) {
    const std::size_t count = hyst_masing_reversals(&model, state);
    const double *stack = state + HYST_MASING_STACK;
    const double infinite = std::numeric_limits<double>::infinity();
    const double far = rising ? infinite : -infinite;
    if (model.last_reversal || count == 0) return {far, far};
    if (count == 1) return {-stack[0], -stack[1]};
    return {stack[2 * (count - 2)], stack[2 * (count - 2) + 1]};
}

// Samples from u[0] on that go on the same way, not as far as the end. A rest at 0 is left to the
// core, which keeps the sign of the zero it came by.
template <bool rising>
std::size_t quiet(const double *u, std::size_t samples, double last, double end) {
    std::size_t k = 0;
    while (k < samples && (rising ? u[k] >= last && u[k] < end : u[k] <= last && u[k] > end) &&
           (u[k] != last || last != 0.0)) {
        last = u[k++];
    }
    return k;
}

template <bool rising>
void keep_in_order(const hyst_masing &model, double last, double end, double *y,
                   std::size_t samples) {
    for (std::size_t k = 0; k < samples; ++k) {
        if (model.last_reversal) {
            last = y[k] = (rising ? y[k] >= last : y[k] <= last) ? y[k] : last;
        } else {
            y[k] = (rising ? y[k] >= end : y[k] <= end) ? end : y[k];
        }
    }
}

template <bool rising>
std::size_t go_on(const hyst_masing &model, double *state, const double *u, double *y,
                  std::size_t samples) {
    constexpr std::size_t block = 2048;  // fits the first cache, and bounds work done in vain
    const End end = end_of(model, state, rising);
    const Branch branch = branch_of(model, state);
    const std::size_t count =
        quiet<rising>(u, std::min(samples, block), state[HYST_MASING_INPUT], end.input);
    if (count < kLanes) return 0;
    const double last_input = u[count - 1];
    // Monotone: if the last output is finite, so are those before it. Else the core shall say.
    double probe;
    stretch(model, branch, &last_input, &probe, 1);
    if (!std::isfinite(probe)) return 0;
    stretch(model, branch, u, y, count);
    keep_in_order<rising>(model, state[HYST_MASING_OUTPUT], end.output, y, count);
    state[HYST_MASING_INPUT] = last_input;
    state[HYST_MASING_OUTPUT] = y[count - 1];
    return count;
}

}  // namespace

void run_masing(const hyst_masing &model, double *state, const double *u, double *y,
                std::size_t samples) {
    std::size_t k = 0;
    while (k < samples) {
        const double input = u[k];  // y may be u
        y[k] = hyst_masing_step(&model, state, input);
        const bool kept = state[HYST_MASING_INPUT] == input;
        ++k;
        if (!kept || k == samples) continue;
        const std::size_t count = hyst_masing_reversals(&model, state);
        const double start = count > 0 ? state[HYST_MASING_STACK + 2 * (count - 1)] : 0.0;
        const double last = state[HYST_MASING_INPUT];
        if (last > start) {
            k += go_on<true>(model, state, u + k, y + k, samples - k);
        } else if (last < start) {
            k += go_on<false>(model, state, u + k, y + k, samples - k);
        }
    }
}

}  // namespace hyst
