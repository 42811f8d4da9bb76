// For an order known to the compiler the matrices stay in registers and the loops vanish; this is
// three to four times faster than one call of the core a sample.
#include <algorithm>
#include <utility>

#include "hyst/linear_dynamics.h"
#include "linear.hpp"

namespace hyst {
namespace {

constexpr std::size_t kLargestUnrolled = 12;

using Run = std::size_t (*)(const hyst_state_space &, double *, const double *, double *,
                            std::size_t);

constexpr std::size_t kBlock = 128;

// Two rows at a time, which every 64-bit machine does in one instruction.
using Pair = double __attribute__((vector_size(16)));

// Gives the number of samples done: all, or those before the block in which a state overflows.
template <std::size_t n>
std::size_t run_unrolled(const hyst_state_space &system, double *state, const double *u, double *y,
                         std::size_t samples) {
    constexpr std::size_t pairs = (n + 1) / 2;
    Pair a[n * pairs + 1] = {}, b[pairs + 1] = {}, next[pairs + 1];
    double c[n + 1], output[kBlock];
    for (std::size_t i = 0; i < n; ++i) {
        b[i / 2][i % 2] = system.b[i];
        for (std::size_t j = 0; j < n; ++j) a[j * pairs + i / 2][i % 2] = system.a[j * n + i];
    }
    std::copy_n(system.c, n, c);
    for (std::size_t start = 0; start < samples; start += kBlock) {
        const std::size_t count = std::min(kBlock, samples - start);
        Pair zero[pairs + 1] = {};  // unless a state was not finite: then NaN
        Pair x[pairs + 1] = {};
        for (std::size_t i = 0; i < n; ++i) x[i / 2][i % 2] = state[i];
        for (std::size_t k = 0; k < count; ++k) {
            const double w = u[start + k];
            double sum = system.d * w;
            for (std::size_t i = 0; i < pairs; ++i) next[i] = b[i] * w;
            for (std::size_t j = 0; j < n; ++j) {
                const double xj = x[j / 2][j % 2];
                sum += c[j] * xj;
                for (std::size_t i = 0; i < pairs; ++i) next[i] += a[j * pairs + i] * xj;
            }
            for (std::size_t i = 0; i < pairs; ++i) zero[i] += next[i] - next[i];
            for (std::size_t i = 0; i < pairs; ++i) x[i] = next[i];
            output[k] = sum;
        }
        double all = 0.0;
        for (std::size_t i = 0; i < pairs; ++i) all += zero[i][0] + zero[i][1];
        if (!(all == 0.0)) return start;
        for (std::size_t i = 0; i < n; ++i) state[i] = x[i / 2][i % 2];
        std::copy_n(output, count, y + start);
    }
    return samples;
}

template <std::size_t... orders>
Run unrolled(std::size_t order, std::index_sequence<orders...>) {
    static constexpr Run runs[] = {run_unrolled<orders>...};
    return order < sizeof...(orders) ? runs[order] : nullptr;
}

}  // namespace

void run_state_space(const void *model, double *state, const double *u, double *y,
                     std::size_t samples) {
    const hyst_state_space &system = *static_cast<const hyst_state_space *>(model);
    const Run run = unrolled(system.order, std::make_index_sequence<kLargestUnrolled + 1>());
    std::size_t k = 0;
    if (run != nullptr && system.delay == 0) k = run(system, state, u, y, samples);
    // What is delayed, of high order or has overflowed takes the core's own step.
    for (; k < samples; ++k) y[k] = hyst_state_space_step(&system, state, u[k]);
}

}  // namespace hyst
