#include "lanes.hpp"

#include <algorithm>
#include <vector>

#include "simd/kernels.hpp"

namespace hyst {
namespace {

bool ascends_from_zero(const hyst_pi &pi) {
    double before = 0.0;
    for (std::size_t i = 0; i < pi.count; ++i) {
        if (!(pi.r[i] >= before)) return false;
        before = pi.r[i];
    }
    return pi.count > 0;
}

// Samples of one lane: a multiple of the width, and no multiple of a page, where the lanes' streams
// would evict each other from the cache.
std::size_t lane_length(std::size_t samples, std::size_t width) {
    constexpr std::size_t page = 4096 / sizeof(double);
    const std::size_t length = samples / width / width * width;
    return length > 0 && length % page == 0 ? length - width : length;
}

}  // namespace

bool Lanes::can_take(const hyst_stage &stage) {
    switch (stage.kind) {
    case HYST_PLAY:
    case HYST_STOP:
        return stage.as.r >= 0.0;
    case HYST_PI:
        return ascends_from_zero(stage.as.pi);
    case HYST_RATE_DEPENDENT_PI:
        return ascends_from_zero(stage.as.rate_dependent_pi.pi);
    default:
        return false;
    }
}

void Lanes::jump(double *state, const double *u, std::size_t count) const {
    if (count == 0) return;
    const Kernels &fast = kernels();
    if (stage_.kind == HYST_RATE_DEPENDENT_PI) {
        const hyst_rate_dependent_pi &model = stage_.as.rate_dependent_pi;
        double *last = state + model.pi.count;  // the previous input, and whether there is one
        fast.rate_dependent_pi_jump(model, last[1] > 0.0 ? last[0] : u[0], u, count, state);
        last[0] = u[count - 1];
        last[1] = 1.0;
    } else if (stage_.kind == HYST_PI) {
        fast.pi_jump(u, count, stage_.as.pi.count, stage_.as.pi.r, state, nullptr);
    } else {
        fast.pi_jump(u, count, 1, &stage_.as.r, state, nullptr);
    }
}

bool Lanes::run_packed(double *packed, const double *u, double *y, std::size_t samples,
                       std::size_t stride) const {
    const Kernels &fast = kernels();
    if (stage_.kind == HYST_RATE_DEPENDENT_PI) {
        const hyst_rate_dependent_pi &model = stage_.as.rate_dependent_pi;
        double *previous = packed + model.pi.count * fast.width;
        const double *exists = previous + fast.width;
        for (std::size_t lane = 0; lane < fast.width; ++lane) {
            if (!(exists[lane] > 0.0)) previous[lane] = u[lane * stride];
        }
        return fast.rate_dependent_pi_lanes(model, previous, u, y, samples, stride, packed);
    }
    if (stage_.kind == HYST_PI) {
        return fast.pi_lanes(stage_.as.pi, u, y, samples, stride, packed);
    }
    return fast.play_lanes(stage_.as.r, stage_.kind == HYST_STOP, u, y, samples, stride, packed);
}

bool Lanes::run(double *state, const double *u, double *y, std::size_t samples) const {
    const std::size_t width = kernels().width, values = hyst_stage_state_length(&stage_);
    const std::size_t length = lane_length(samples, width), in_lanes = length * width;
    std::vector<double> packed(values * width);
    std::vector<double> end(state, state + values);
    for (std::size_t lane = 0; lane < width; ++lane) {
        for (std::size_t i = 0; i < values; ++i) packed[i * width + lane] = end[i];
        jump(end.data(), u + lane * length, length);
    }
    const std::size_t rest = samples - in_lanes;
    const bool finite = all_finite(u + in_lanes, rest) &&
                        (length == 0 || run_packed(packed.data(), u, y, length, length));
    std::copy(end.begin(), end.end(), state);
    hyst_stage_run(&stage_, state, u + in_lanes, y + in_lanes, rest);
    return finite && all_finite(y + in_lanes, rest);
}

bool Lanes::run_rows(double *states, const double *u, double *y, std::size_t samples) const {
    const std::size_t width = kernels().width, values = hyst_stage_state_length(&stage_);
    const std::size_t in_lanes = samples / width * width;
    std::vector<double> packed(values * width);
    for (std::size_t row = 0; row < width; ++row) {
        for (std::size_t i = 0; i < values; ++i) packed[i * width + row] = states[row * values + i];
        jump(&states[row * values], u + row * samples, in_lanes);
    }
    bool finite = run_packed(packed.data(), u, y, in_lanes, samples);
    for (std::size_t row = 0; row < width; ++row) {
        const std::size_t first = row * samples + in_lanes, rest = samples - in_lanes;
        finite = finite && all_finite(u + first, rest);
        hyst_stage_run(&stage_, states + row * values, u + first, y + first, rest);
        finite = finite && all_finite(y + first, rest);
    }
    return finite;
}

}  // namespace hyst
