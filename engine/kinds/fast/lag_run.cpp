// A lag keeps its state in registers; what is finite is asked for once a block.
#include "hyst/lag.h"

#include <algorithm>

#include "creep.hpp"

namespace hyst {
namespace {

constexpr std::size_t kBlock = 128;

// Gives the number of samples done: all, or those before the block in which something overflows.
template <bool inverse>
std::size_t run_started(const hyst_lag &model, double *state, const double *u, double *y,
                        std::size_t samples) {
    const double gain = model.gain, through = model.through, per_through = model.per_through;
    double reached = state[0], carried = state[1], before = state[2];
    double output[kBlock];
    for (std::size_t start = 0; start < samples; start += kBlock) {
        const std::size_t count = std::min(kBlock, samples - start);
        double zero = 0.0;  // unless something was not finite: then NaN
        for (std::size_t k = 0; k < count; ++k) {
            const double in = u[start + k], way = gain * (before - reached) + carried;
            const double driven = inverse ? before + ((in - reached) - way) * per_through : in;
            const double step = way + through * (driven - before);
            const double next = reached + step;
            carried = step - (next - reached);
            zero += (carried - carried) + (driven - driven);
            reached = next;
            before = driven;
            output[k] = inverse ? driven : next;
        }
        if (!(zero == 0.0)) return start;
        state[0] = reached;
        state[1] = carried;
        state[2] = before;
        std::copy_n(output, count, y + start);
    }
    return samples;
}

}  // namespace

void run_lag(const void *of, double *state, const double *u, double *y, std::size_t samples) {
    const hyst_lag &model = *static_cast<const hyst_lag *>(of);
    std::size_t k = 0;
    // The first sample that is finite starts it.
    for (; k < samples && !(state[3] > 0.0); ++k) y[k] = hyst_lag_step(&model, state, u[k]);
    k += model.inverse != 0 ? run_started<true>(model, state, u + k, y + k, samples - k)
                            : run_started<false>(model, state, u + k, y + k, samples - k);
    for (; k < samples; ++k) y[k] = hyst_lag_step(&model, state, u[k]);
}

}  // namespace hyst
