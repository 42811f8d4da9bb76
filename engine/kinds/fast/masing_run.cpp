// The core's step decides at every event: a reversal, a loop that closes, a rest. While the input
// goes one way inside a loop nothing is decided, and all samples of the stretch are points of one
// branch, which kernels evaluate in packs; tests hold them to the core's bits.
#include <algorithm>
#include <cmath>
#include <limits>

#include "../../simd/kernels.hpp"
#include "hyst/masing.h"
#include "masing.hpp"

namespace hyst {
namespace {

constexpr std::size_t kFewest = 4;  // samples of a stretch that are worth its preparation

Branch branch_of(const hyst_masing &model, const double *state) {
    const std::size_t count = hyst_masing_reversals(&model, state);
    if (count == 0) return {1.0, 0.0, 0.0, 1.0};
    const double *top = state + HYST_MASING_STACK + 2 * (count - 1);
    return {0.5, 0.5 * top[0], top[1], 2.0};
}

void stretch(const hyst_masing &model, const Branch &branch, const double *u, double *y,
             std::size_t samples) {
    if (model.curve.kind == HYST_POWER_LAW) {
        const Kernels &all = kernels();
        const auto along = model.inverse ? all.inverse_power_law_branch : all.power_law_branch;
        along(model.curve.as.power_law, branch, u, y, samples);
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
            y[k] = (rising ? y[k] > end : y[k] < end) ? end : y[k];
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
    if (count < kFewest) return 0;
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

void run_masing(const void *of, double *state, const double *u, double *y, std::size_t samples) {
    const hyst_masing &model = *static_cast<const hyst_masing *>(of);
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
