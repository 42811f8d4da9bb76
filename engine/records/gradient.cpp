#include "gradient.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "evaluation.hpp"
#include "hyst/play.h"
#include "../jacobian.hpp"
#include "lanes.hpp"
#include "memory_curve.hpp"
#include "../parallel.hpp"
#include "../simd/kernels.hpp"

namespace hyst {
namespace {

// Memory of a bank for derivatives: where each play is, and which way it moved last (0: never).
struct Memory {
    std::vector<double> z;
    std::vector<double> direction;

    void jump(const hyst_pi &pi, const double *u, std::size_t count) {
        kernels().pi_jump(u, count, pi.count, pi.r, z.data(), direction.data());
    }
};

// Loss and sums over a part of the record; by_direction is turned into the gradient by r at the end.
struct Sums {
    double loss = 0.0, by_p0 = 0.0;
    double largest = 0.0;  // magnitude of the input
    std::vector<double> by_p, by_direction;

    explicit Sums(std::size_t plays) : by_p(plays, 0.0), by_direction(plays, 0.0) {}

    void add(const Sums &other) {
        loss += other.loss;
        by_p0 += other.by_p0;
        largest = std::max(largest, other.largest);
        for (std::size_t i = 0; i < by_p.size(); ++i) by_p[i] += other.by_p[i];
        for (std::size_t i = 0; i < by_p.size(); ++i) by_direction[i] += other.by_direction[i];
    }
};

void step_by_step(const hyst_pi &pi, Memory &memory, const double *u, const double *target,
                  std::size_t samples, Sums &sums) {
    for (std::size_t k = 0; k < samples; ++k) {
        double error = pi.p0 * u[k] - target[k];
        for (std::size_t i = 0; i < pi.count; ++i) {
            const double before = memory.z[i], now = hyst_play(u[k], pi.r[i], before);
            if (now != before) memory.direction[i] = now > before ? kRose : kFell;
            memory.z[i] = now;
            error += pi.p[i] * now;
        }
        sums.largest = std::max(sums.largest, std::abs(u[k]));
        sums.loss += 0.5 * error * error;
        sums.by_p0 += error * u[k];
        for (std::size_t i = 0; i < pi.count; ++i) {
            sums.by_p[i] += error * memory.z[i];
            sums.by_direction[i] += error * memory.direction[i];
        }
    }
}

double sum_of(const double *values, std::size_t count) {
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) sum += values[i];
    return sum;
}

// A part of the record in time lanes; what is left over is taken step by step.
void in_lanes(const hyst_pi &pi, const Memory &start, const double *u, const double *target,
              std::size_t samples, Sums &sums) {
    const Kernels &fast = kernels();
    Memory memory = start;
    const std::size_t width = fast.width, n = pi.count;
    const std::size_t length = samples / width / width * width;
    std::vector<double> z(n * width), direction(n * width), by_p(n * width), by_direction(n * width);
    std::vector<double> scratch(2 * n * width * width);
    for (std::size_t lane = 0; lane < width; ++lane) {
        for (std::size_t i = 0; i < n; ++i) z[i * width + lane] = memory.z[i];
        for (std::size_t i = 0; i < n; ++i) direction[i * width + lane] = memory.direction[i];
        memory.jump(pi, u + lane * length, length);
    }
    const GradientBank bank{pi,          z.data(),           direction.data(),
                            by_p.data(), by_direction.data(), scratch.data()};
    const GradientSums found = fast.gradient_lanes(bank, u, target, length, length);
    sums.loss += found.loss;
    sums.by_p0 += found.by_p0;
    sums.largest = std::max(sums.largest, found.largest);
    for (std::size_t i = 0; i < n; ++i) sums.by_p[i] += sum_of(&by_p[i * width], width);
    for (std::size_t i = 0; i < n; ++i) {
        sums.by_direction[i] += sum_of(&by_direction[i * width], width);
    }
    const std::size_t done = length * width;
    step_by_step(pi, memory, u + done, target + done, samples - done, sums);
}

// The choice that evaluation makes of the same record.
bool takes_curve(const hyst_pi &pi, const double *z, const double *u, std::size_t samples,
                 Engine wanted) {
    return choose(stage_of(pi), z, u, samples, wanted).engine == Engine::memory_curve;
}

// A part of the record along the memory curve.
void along_curve(const hyst_pi &pi, const Memory &memory, const double *u, const double *target,
                 std::size_t samples, Sums &sums) {
    constexpr std::size_t block = 4096;
    const Kernels &fast = kernels();
    const std::size_t n = pi.count;
    const MemoryCurve curve(pi, memory.z.data());
    std::vector<double> by_input(n + 1), by_way(n + 1), from_start(n), y(block);
    CurveGradientData data{curve.data(), by_input.data(), by_way.data(), from_start.data(),
                           0.0,          0.0,             0.0};
    for (std::size_t k = 0; k < samples; k += block) {
        fast.curve_gradient(data, u + k, target + k, y.data(), std::min(block, samples - k));
    }
    fast.finish_curve_gradient(data);
    sums.loss += data.loss;
    sums.by_p0 += data.by_p0;
    sums.largest = data.curve.largest;
    double input = 0.0, way = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        input += by_input[i];
        way += by_way[i];
        sums.by_p[i] += input + pi.r[i] * way + memory.z[i] * from_start[i];
        sums.by_direction[i] += way + memory.direction[i] * from_start[i];
    }
}

// Of a single bank: by p0, p_1 .. p_n, r_1 .. r_n. Returns false, and nothing of use, where only the
// core's order of operations tells whether y overflows.
bool bank_loss_gradient(const hyst_pi &pi, double *z, const double *u, const double *target,
                        std::size_t samples, const Options &options, double *gradient,
                        double &loss) {
    const std::size_t n = pi.count;
    const std::size_t parts = std::max<std::size_t>(1, std::min(options.threads, samples / 16384));
    const std::size_t length = samples / parts;
    const bool curved = takes_curve(pi, z, u, samples, options.engine);
    std::vector<Memory> starts;
    Memory memory{{z, z + n}, std::vector<double>(n, 0.0)};
    for (std::size_t part = 0; part < parts; ++part) {
        starts.push_back(memory);
        const std::size_t first = part * length;
        memory.jump(pi, u + first, part + 1 < parts ? length : samples - first);
    }
    std::vector<Sums> sums(parts, Sums(n));
    parallel(parts, options.threads, [&](std::size_t part) {
        const std::size_t first = part * length;
        const std::size_t count = part + 1 < parts ? length : samples - first;
        const auto add = curved ? along_curve : in_lanes;
        add(pi, starts[part], u + first, target + first, count, sums[part]);
    });
    for (std::size_t part = 1; part < parts; ++part) sums[0].add(sums[part]);
    if (!(sums[0].largest <= headroom(pi, z, kHuge))) return false;
    gradient[0] = sums[0].by_p0;
    for (std::size_t i = 0; i < n; ++i) gradient[1 + i] = sums[0].by_p[i];
    for (std::size_t i = 0; i < n; ++i) gradient[1 + n + i] = pi.p[i] * sums[0].by_direction[i];
    std::copy(memory.z.begin(), memory.z.end(), z);
    loss = sums[0].loss;
    return true;
}

}  // namespace

double loss_gradient(const Chain &chain, double *state, const double *u, const double *target,
                     std::size_t samples, const Options &options, double *gradient) {
    const Stage *stage = chain.stages().data();
    double loss = 0.0;
    if (chain.stages().size() == 1 && stage->kind == &kinds::pi && Lanes::can_take(*stage) &&
        bank_loss_gradient(*static_cast<const hyst_pi *>(stage->model), state, u, target, samples,
                           options, gradient, loss)) {
        return loss;
    }
    const std::size_t width = chain.parameter_count();
    std::vector<double> y(samples), rows(samples * width), start(state, state + chain.state_length());
    jacobian(chain, start.data(), u, samples, Derivative::automatic, rows.data());
    std::fill(gradient, gradient + width, 0.0);
    if (evaluate(chain, state, u, y.data(), 1, samples, options, nullptr) < samples) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    for (std::size_t k = 0; k < samples; ++k) {
        const double error = y[k] - target[k];
        loss += 0.5 * error * error;
        for (std::size_t c = 0; c < width; ++c) gradient[c] += error * rows[k * width + c];
    }
    return loss;
}

}  // namespace hyst
