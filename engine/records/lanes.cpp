#include "lanes.hpp"

#include <algorithm>
#include <vector>

#include "../simd/kernels.hpp"

namespace hyst {
namespace {

// Samples of one lane: a multiple of the width, and no multiple of a page, where the lanes' streams
// would evict each other from the cache.
std::size_t lane_length(std::size_t samples, std::size_t width) {
    constexpr std::size_t page = 4096 / sizeof(double);
    const std::size_t length = samples / width / width * width;
    return length > 0 && length % page == 0 ? length - width : length;
}

}  // namespace

bool Lanes::can_take(const Stage &stage) {
    return stage.kind->plays != nullptr && stage.kind->plays->can_take(stage.model);
}

void Lanes::jump(double *state, const double *u, std::size_t count) const {
    if (count > 0) stage_.kind->plays->jump(stage_.model, state, u, count);
}

bool Lanes::run_packed(double *packed, const double *u, double *y, std::size_t samples,
                       std::size_t stride) const {
    return stage_.kind->plays->run(stage_.model, packed, u, y, samples, stride);
}

bool Lanes::run(double *state, const double *u, double *y, std::size_t samples) const {
    const std::size_t width = kernels().width, values = stage_.state_length();
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
    stage_.step_through(state, u + in_lanes, y + in_lanes, rest);
    return finite && all_finite(y + in_lanes, rest);
}

bool Lanes::run_rows(double *states, const double *u, double *y, std::size_t samples) const {
    const std::size_t width = kernels().width, values = stage_.state_length();
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
        stage_.step_through(states + row * values, u + first, y + first, rest);
        finite = finite && all_finite(y + first, rest);
    }
    return finite;
}

}  // namespace hyst
