// A lag waits for its own last step; all lags of a sample are independent of one another, so that as
// many as a compiler can keep in registers take no longer than one. What is finite is asked for once a
// block.
#include "hyst/creep.h"

#include <algorithm>
#include <utility>

#include "creep.hpp"

namespace hyst {
namespace {

constexpr std::size_t kMostPairs = 5;
constexpr std::size_t kBlock = 128;

// Two lags at a time, which every 64-bit machine does in one instruction.
using Pair = double __attribute__((vector_size(16)));
using Run = std::size_t (*)(const hyst_creep &, double *, const double *, double *, std::size_t);

// Gives the number of samples done: all, or those before the block in which something overflows.
template <std::size_t n, bool inverse>
std::size_t run_lags(const hyst_creep &model, double *state, const double *u, double *y,
                     std::size_t samples) {
    constexpr std::size_t pairs = (n + 1) / 2;
    Pair weight[pairs] = {}, gain[pairs] = {}, x[pairs] = {}, carried[pairs] = {};
    for (std::size_t i = 0; i < n; ++i) {
        weight[i / 2][i % 2] = model.weight[i];
        gain[i / 2][i % 2] = model.gain[i];
        x[i / 2][i % 2] = state[2 * i];
        carried[i / 2][i % 2] = state[2 * i + 1];
    }
    double output[kBlock];
    for (std::size_t start = 0; start < samples; start += kBlock) {
        const std::size_t count = std::min(kBlock, samples - start);
        Pair zero[pairs] = {};  // unless a way was not finite: then NaN
        double none = 0.0;      // likewise of the outputs
        for (std::size_t k = 0; k < count; ++k) {
            double crept = 0.0;
            for (std::size_t i = 0; i < pairs; ++i) {
                const Pair share = weight[i] * x[i];
                crept += share[0];
                if (2 * i + 1 < n) crept += share[1];
            }
            const double in = u[start + k];
            const double out = inverse ? in - crept : in + crept;
            const double driven = inverse ? out : in;
            none += out - out;
            for (std::size_t i = 0; i < pairs; ++i) {
                const Pair way = Pair{driven, driven} - x[i];
                zero[i] += way - way;
                const Pair step = gain[i] * way + carried[i];
                const Pair next = x[i] + step;
                carried[i] = step - (next - x[i]);
                x[i] = next;
            }
            output[k] = out;
        }
        for (std::size_t i = 0; i < pairs; ++i) none += zero[i][0] + zero[i][1];
        if (!(none == 0.0)) return start;
        for (std::size_t i = 0; i < n; ++i) {
            state[2 * i] = x[i / 2][i % 2];
            state[2 * i + 1] = carried[i / 2][i % 2];
        }
        std::copy_n(output, count, y + start);
    }
    return samples;
}

template <bool inverse, std::size_t... less>
Run run_of(std::size_t lags, std::index_sequence<less...>) {
    static constexpr Run runs[] = {run_lags<less + 1, inverse>...};
    return lags > 0 && lags <= sizeof...(less) ? runs[lags - 1] : nullptr;
}

}  // namespace

void run_creep(const void *of, double *state, const double *u, double *y, std::size_t samples) {
    const hyst_creep &model = *static_cast<const hyst_creep *>(of);
    constexpr auto counts = std::make_index_sequence<2 * kMostPairs>();
    const Run run = model.inverse != 0 ? run_of<true>(model.count, counts)
                                       : run_of<false>(model.count, counts);
    std::size_t k = run != nullptr ? run(model, state, u, y, samples) : 0;
    // Many lags, or what has overflowed, take the core's own step.
    for (; k < samples; ++k) y[k] = hyst_creep_step(&model, state, u[k]);
}

}  // namespace hyst
