// For an order known to the compiler the matrices stay in registers and the loops vanish; this is
// three to four times faster than one call of the core a sample.
#include "linear_run.hpp"

#include <algorithm>
#include <utility>

namespace hyst {
namespace {

constexpr std::size_t kLargestUnrolled = 12;

using Run = std::size_t (*)(const hyst_state_space &, double *, const double *, double *,
                            std::size_t);

// Gives the number of samples done: all, or those before the first whose next state overflows.
template <std::size_t n>
std::size_t run_unrolled(const hyst_state_space &system, double *state, const double *u, double *y,
                         std::size_t samples) {
    double a[n * n + 1], b[n + 1], c[n + 1], x[n + 1], next[n + 1];
    std::copy_n(system.a, n * n, a);
    std::copy_n(system.b, n, b);
    std::copy_n(system.c, n, c);
    std::copy_n(state, n, x);
    std::size_t k = 0;
    for (; k < samples; ++k) {
        const double w = u[k];
        double sum = system.d * w, zero = 0.0;
        for (std::size_t i = 0; i < n; ++i) next[i] = b[i] * w;
        for (std::size_t j = 0; j < n; ++j) {
            sum += c[j] * x[j];
            for (std::size_t i = 0; i < n; ++i) next[i] += a[j * n + i] * x[j];
        }
        for (std::size_t i = 0; i < n; ++i) zero += next[i] - next[i];
        if (!(zero == 0.0)) break;
        for (std::size_t i = 0; i < n; ++i) x[i] = next[i];
        y[k] = sum;
    }
    std::copy_n(x, n, state);
    return k;
}

template <std::size_t... orders>
Run unrolled(std::size_t order, std::index_sequence<orders...>) {
    static constexpr Run runs[] = {run_unrolled<orders>...};
    return order < sizeof...(orders) ? runs[order] : nullptr;
}

}  // namespace

void run_state_space(const hyst_state_space &system, double *state, const double *u, double *y,
                     std::size_t samples) {
    const Run run = unrolled(system.order, std::make_index_sequence<kLargestUnrolled + 1>());
    std::size_t k = 0;
    if (run != nullptr && system.delay == 0) k = run(system, state, u, y, samples);
    // What is delayed, of high order or has overflowed takes the core's own step.
    for (; k < samples; ++k) y[k] = hyst_state_space_step(&system, state, u[k]);
}

}  // namespace hyst
