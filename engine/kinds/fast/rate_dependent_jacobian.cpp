// The derivative of plays whose bounds move with the rate of the input; see plays_jacobian.cpp.
#include <algorithm>
#include <cmath>
#include <vector>

#include "bank_sum.hpp"
#include "hyst/play.h"
#include "hyst/rate_dependent_prandtl_ishlinskii.h"
#include "plays.hpp"

namespace hyst {
namespace {

// The rate of a rate-dependent stage at one sample, and what the widening depends on.
struct Widening {
    double value;
    double slope;                // derivative by the input's change, with its sign
    std::vector<double> basis;   // derivatives by beta, the powers and the slopes of the ramps

    explicit Widening(const hyst_rate_dependent_pi &model)
        : value(0.0), slope(0.0), basis(1 + model.powers + model.ramps.count) {}

    void at(const hyst_rate_dependent_pi &model, double change, double dt) {
        const double x = std::fabs(change), rate = x / dt;
        value = hyst_widening(&model, x);
        double by_change = model.growth, power = x;
        basis[0] = rate;
        for (std::size_t m = 0; m < model.powers; ++m) {
            basis[1 + m] = basis[m] * rate;
            by_change += static_cast<double>(m + 2) * model.power[m] * power;
            power *= x;
        }
        for (std::size_t j = 0; j < model.ramps.count; ++j) {
            const double beyond = x - model.ramps.threshold[j];
            basis[1 + model.powers + j] = beyond > 0.0 ? beyond / dt : 0.0;
            by_change += beyond > 0.0 ? model.ramps.weight[j] : 0.0;
        }
        slope = change > 0.0 ? by_change : change < 0.0 ? -by_change : 0.0;
    }
};

// A play whose bounds move with the input and with the widening.
struct RateDependentPlay {
    double z;
    double by_r = 0.0;
    std::vector<double> by_basis, by_input;

    RateDependentPlay(double start, std::size_t basis, std::size_t incoming)
        : z(start), by_basis(basis, 0.0), by_input(incoming, 0.0) {}

    void step(double u, double r, const Widening &w, const double *now, const double *before) {
        const double pushed = hyst_clamp((u - w.value) - r, (u + w.value) + r, z);
        const double side = pushed > z ? -1.0 : pushed < z ? 1.0 : 0.0;
        // At threshold 0 both bounds are the input itself.
        const bool rests = side == 0.0 && (r > 0.0 || w.value > 0.0);
        z = pushed;
        if (rests) return;
        by_r = side;
        for (std::size_t b = 0; b < by_basis.size(); ++b) by_basis[b] = side * w.basis[b];
        for (std::size_t c = 0; c < by_input.size(); ++c) {
            by_input[c] = now[c] + side * w.slope * (now[c] - before[c]);
        }
    }
};

}  // namespace

void rate_dependent_pi_jacobian(const void *of, double dt, const double *start, const Tangents &t) {
    const hyst_rate_dependent_pi &model = *static_cast<const hyst_rate_dependent_pi *>(of);
    const hyst_pi &pi = model.pi;
    Widening widening(model);
    const std::size_t basis = widening.basis.size();
    std::vector<RateDependentPlay> plays;
    for (std::size_t i = 0; i < pi.count; ++i) plays.emplace_back(start[i], basis, t.incoming);
    const bool started = start[pi.count + 1] > 0.0;
    double previous = started ? start[pi.count] : t.signal[0];
    // What came before the record does not depend on the parameters.
    std::vector<double> now(t.incoming), before(t.incoming, 0.0);
    if (!started) before.assign(t.row(0), t.row(0) + t.incoming);
    for (std::size_t k = 0; k < t.samples; ++k) {
        const double u = t.signal[k];
        double *own = t.own(k);
        now.assign(t.row(k), t.row(k) + t.incoming);
        widening.at(model, u - previous, dt);
        previous = u;
        own[0] = u;
        double *by_basis = own + 1 + 2 * pi.count;
        std::fill(by_basis, by_basis + basis, 0.0);
        t.scale(k, pi.p0);
        for (std::size_t i = 0; i < pi.count; ++i) {
            plays[i].step(u, pi.r[i], widening, now.data(), before.data());
            own[1 + i] = plays[i].z;
            own[1 + pi.count + i] = pi.p[i] * plays[i].by_r;
            for (std::size_t b = 0; b < basis; ++b) by_basis[b] += pi.p[i] * plays[i].by_basis[b];
            for (std::size_t c = 0; c < t.incoming; ++c) {
                t.row(k)[c] += pi.p[i] * plays[i].by_input[c];
            }
        }
        before.swap(now);
        const auto product = [&](std::size_t i) { return pi.p[i] * plays[i].z; };
        t.signal[k] = bank_sum(pi.count, pi.p0 * u, product);
    }
}

}  // namespace hyst
