// The core's step decides at every event: a reversal, a loop that closes, a rest. While the input goes
// one way inside a loop nothing is decided, and all samples up to the next threshold are points of one
// piece; tests hold them to the core's bits.
#include <algorithm>
#include <cmath>
#include <limits>

#include "hyst/preisach.h"
#include "preisach.hpp"

namespace hyst {
namespace {

// The branch that a state is on, in inputs and outputs of the operator, be it the inverse or not.
struct Branch {
    bool has_start;
    hyst_preisach_point start;
    double begin;              // input where it starts
    double end, end_output;    // where its loop closes
};

hyst_preisach_point kept(const double *state, std::size_t index) {
    const double *place = state + HYST_PREISACH_STACK + 2 * index;
    return {place[0], place[1]};
}

Branch branch_of(const hyst_preisach &model, const double *state) {
    const std::size_t count = hyst_preisach_reversals(&model, state);
    if (count == 0) {
        const double begin = model.inverse ? model.rising[1] : 0.0;
        const bool rising = state[HYST_PREISACH_INPUT] > begin;
        const double far = std::numeric_limits<double>::infinity() * (rising ? 1.0 : -1.0);
        return {false, {}, begin, far, far};
    }
    const hyst_preisach_point start = kept(state, count - 1);
    hyst_preisach_point end;
    if (count >= 2) {
        end = kept(state, count - 2);
    } else {
        end.u = -start.u;
        const hyst_preisach_piece mirror = hyst_preisach_to_input(&model, nullptr, end.u);
        end.y = hyst_preisach_output(&mirror, end.u);
    }
    if (model.inverse) return {true, start, start.y, end.y, end.u};
    return {true, start, start.u, end.u, end.y};
}

// Samples that go on the same way, not as far as `limit`.
template <bool rising>
std::size_t quiet(const double *u, std::size_t samples, double last, double limit) {
    std::size_t k = 0;
    while (k < samples && (rising ? u[k] >= last && u[k] < limit : u[k] <= last && u[k] > limit)) {
        last = u[k++];
    }
    return k;
}

template <bool inverse>
void along(const hyst_preisach_piece &piece, const double *u, double *y, std::size_t samples) {
    for (std::size_t k = 0; k < samples; ++k) {
        y[k] = inverse ? hyst_preisach_input(&piece, u[k]) : hyst_preisach_output(&piece, u[k]);
    }
}

template <bool rising, bool inverse>
std::size_t go_on(const hyst_preisach &model, double *state, const Branch &branch, const double *u,
                  double *y, std::size_t samples) {
    const hyst_preisach_point *start = branch.has_start ? &branch.start : nullptr;
    double last = state[HYST_PREISACH_INPUT];
    std::size_t done = 0;
    while (done < samples && quiet<rising>(u + done, 1, last, branch.end) == 1) {
        const hyst_preisach_piece piece = inverse ? hyst_preisach_to_output(&model, start, u[done])
                                                  : hyst_preisach_to_input(&model, start, u[done]);
        const double until = inverse ? piece.to.y : piece.to.u;
        // What has no end may overflow; the core shall say.
        if (!piece.has_end) break;
        const double limit = rising ? std::min(until, branch.end) : std::max(until, branch.end);
        // A piece holds at least the sample it was made for.
        const std::size_t count =
            1 + quiet<rising>(u + done + 1, samples - done - 1, u[done], limit);
        last = u[done + count - 1];
        along<inverse>(piece, u + done, y + done, count);
        for (std::size_t k = done; k < done + count; ++k) {
            y[k] = (rising ? y[k] >= branch.end_output : y[k] <= branch.end_output)
                       ? branch.end_output
                       : y[k];
        }
        done += count;
    }
    if (done > 0) {
        state[HYST_PREISACH_INPUT] = last;
        state[HYST_PREISACH_OUTPUT] = y[done - 1];
    }
    return done;
}

template <bool inverse>
void run(const hyst_preisach &model, double *state, const double *u, double *y,
         std::size_t samples) {
    std::size_t k = 0;
    while (k < samples) {
        const double input = u[k];  // y may be u
        y[k] = hyst_preisach_step(&model, state, input);
        ++k;
        if (k == samples || state[HYST_PREISACH_INPUT] != input) continue;
        // A branch is worth looking up if the next sample may still be on it.
        const std::size_t count = hyst_preisach_reversals(&model, state);
        const double begin = count > 0 ? (inverse ? kept(state, count - 1).y : kept(state, count - 1).u)
                             : inverse ? model.rising[1]
                                       : 0.0;
        if (input > begin && u[k] >= input) {
            k += go_on<true, inverse>(model, state, branch_of(model, state), u + k, y + k, samples - k);
        } else if (input < begin && u[k] <= input) {
            k += go_on<false, inverse>(model, state, branch_of(model, state), u + k, y + k,
                                       samples - k);
        }
    }
}

}  // namespace

void run_preisach(const void *of, double *state, const double *u, double *y, std::size_t samples) {
    const hyst_preisach &model = *static_cast<const hyst_preisach *>(of);
    if (model.inverse) {
        run<true>(model, state, u, y, samples);
    } else {
        run<false>(model, state, u, y, samples);
    }
}

}  // namespace hyst
