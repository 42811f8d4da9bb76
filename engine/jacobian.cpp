// The derivative of a play is remembered like the play itself (contact-sample rule):
// while z is pushed, z = u -+ r, so dz = du -+ dr; while it rests, dz is what it was at the
// last sample that pushed it. So each stage keeps one tangent per play and incoming parameter.
#include "jacobian.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "evaluation.hpp"
#include "simd/kernels.hpp"

#include "linear_jacobian.hpp"
#include "masing_jacobian.hpp"
#include "memory_element_jacobian.hpp"

namespace hyst {
namespace {

// Where a stage finds the record and the tangents: columns [0, incoming) hold the derivatives of
// its input on entry and of its output on exit; its own columns start at `incoming`.
struct Tangents {
    double *signal;
    std::size_t samples;
    double *rows;
    std::size_t stride;
    std::size_t incoming;

    double *row(std::size_t k) const { return rows + k * stride; }
    double *own(std::size_t k) const { return row(k) + incoming; }
    void scale(std::size_t k, double factor) const {
        for (std::size_t c = 0; c < incoming; ++c) row(k)[c] *= factor;
    }
};

void affine(const hyst_affine &map, const Tangents &t) {
    for (std::size_t k = 0; k < t.samples; ++k) {
        t.scale(k, map.gain);
        t.own(k)[0] = t.signal[k];
        t.own(k)[1] = 1.0;
        t.signal[k] = map.gain * t.signal[k] + map.offset;
    }
}

// Value and slope of one dead-zone term, and its derivative by the threshold.
struct Term {
    double value;
    double slope;
    double by_threshold;
};

Term two_sided(double u, double rho) {
    if (rho == 0.0) return {u, 1.0, 0.0};
    const bool active = rho > 0.0 ? u > rho : u < rho;
    return active ? Term{u - rho, 1.0, -1.0} : Term{0.0, 0.0, 0.0};
}

Term by_direction(double u_previous, double u, double rho) {
    if (u > u_previous && u > rho) return {u - rho, 1.0, -1.0};
    if (u < u_previous && u < -rho) return {u + rho, 1.0, 1.0};
    return {0.0, 0.0, 0.0};
}

void dead_zone(const hyst_dead_zone &map, const double *u_previous, const Tangents &t) {
    double before = u_previous ? *u_previous : 0.0;
    for (std::size_t k = 0; k < t.samples; ++k) {
        const double u = t.signal[k];
        double y = 0.0, slope = 0.0;
        for (std::size_t i = 0; i < map.count; ++i) {
            const double rho = map.threshold[i];
            const Term term = u_previous ? by_direction(before, u, rho) : two_sided(u, rho);
            y += map.weight[i] * term.value;
            slope += map.weight[i] * term.slope;
            t.own(k)[i] = term.value;
            t.own(k)[map.count + i] = map.weight[i] * term.by_threshold;
        }
        t.scale(k, slope);
        t.signal[k] = y;
        before = u;
    }
}

// One play with the derivatives it remembers: by its threshold and by every incoming parameter.
struct RememberingPlay {
    double z;
    double by_r = 0.0;
    std::vector<double> by_input;

    RememberingPlay(double start, std::size_t incoming) : z(start), by_input(incoming, 0.0) {}

    void step(double u, double r, const double *input_tangent) {
        const double pushed = hyst_play(u, r, z);
        if (pushed != z) {
            by_r = pushed > z ? -1.0 : 1.0;
        } else if (r > 0.0) {
            return;  // resting; a play of threshold 0 never rests
        }
        by_input.assign(input_tangent, input_tangent + by_input.size());
        z = pushed;
    }
};

void play_or_stop(const hyst_stage &stage, double start, const Tangents &t) {
    const bool is_stop = stage.kind == HYST_STOP;
    RememberingPlay play(start, t.incoming);
    for (std::size_t k = 0; k < t.samples; ++k) {
        const double u = t.signal[k];
        play.step(u, stage.as.r, t.row(k));
        for (std::size_t c = 0; c < t.incoming; ++c) {
            double &tangent = t.row(k)[c];
            tangent = is_stop ? tangent - play.by_input[c] : play.by_input[c];
        }
        t.own(k)[0] = is_stop ? -play.by_r : play.by_r;
        t.signal[k] = is_stop ? u - play.z : play.z;
    }
}

// A bank whose input does not depend on any parameter: nothing to remember but each play's way.
void first_prandtl_ishlinskii(const hyst_stage &stage, const double *start, const Tangents &t) {
    const hyst_pi &pi = stage.as.pi;
    std::vector<double> z(start, start + pi.count), direction(pi.count, 0.0);
    for (std::size_t k = 0; k < t.samples; ++k) t.own(k)[0] = t.signal[k];
    kernels().derivative_rows(pi, z.data(), direction.data(), t.signal, t.samples, t.own(0) + 1,
                              t.own(0) + 1 + pi.count, t.stride);
    std::copy(start, start + pi.count, z.begin());
    evaluate_stage(stage, z.data(), t.signal, t.signal, t.samples, {});
}

void prandtl_ishlinskii(const hyst_stage &stage, const double *start, const Tangents &t) {
    if (t.incoming == 0) return first_prandtl_ishlinskii(stage, start, t);
    const hyst_pi &pi = stage.as.pi;
    std::vector<RememberingPlay> plays;
    for (std::size_t i = 0; i < pi.count; ++i) plays.emplace_back(start[i], t.incoming);
    for (std::size_t k = 0; k < t.samples; ++k) {
        const double u = t.signal[k];
        double *own = t.own(k);
        double y = pi.p0 * u;
        own[0] = u;
        for (std::size_t i = 0; i < pi.count; ++i) {
            plays[i].step(u, pi.r[i], t.row(k));
            y += pi.p[i] * plays[i].z;
            own[1 + i] = plays[i].z;
            own[1 + pi.count + i] = pi.p[i] * plays[i].by_r;
        }
        t.scale(k, pi.p0);
        for (std::size_t c = 0; c < t.incoming; ++c) {
            for (std::size_t i = 0; i < pi.count; ++i) t.row(k)[c] += pi.p[i] * plays[i].by_input[c];
        }
        t.signal[k] = y;
    }
}

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

void rate_dependent_pi(const hyst_rate_dependent_pi &model, double dt, const double *start,
                       const Tangents &t) {
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
        double y = pi.p0 * u;
        own[0] = u;
        double *by_basis = own + 1 + 2 * pi.count;
        std::fill(by_basis, by_basis + basis, 0.0);
        t.scale(k, pi.p0);
        for (std::size_t i = 0; i < pi.count; ++i) {
            plays[i].step(u, pi.r[i], widening, now.data(), before.data());
            y += pi.p[i] * plays[i].z;
            own[1 + i] = plays[i].z;
            own[1 + pi.count + i] = pi.p[i] * plays[i].by_r;
            for (std::size_t b = 0; b < basis; ++b) by_basis[b] += pi.p[i] * plays[i].by_basis[b];
            for (std::size_t c = 0; c < t.incoming; ++c) {
                t.row(k)[c] += pi.p[i] * plays[i].by_input[c];
            }
        }
        before.swap(now);
        t.signal[k] = y;
    }
}

void pass(const hyst_stage &stage, double dt, const double *state, const Tangents &t) {
    switch (stage.kind) {
    case HYST_AFFINE:
        return affine(stage.as.affine, t);
    case HYST_PLAY:
    case HYST_STOP:
        return play_or_stop(stage, state[0], t);
    case HYST_DEAD_ZONE:
        return dead_zone(stage.as.dead_zone, nullptr, t);
    case HYST_DIRECTION_DEAD_ZONE:
        return dead_zone(stage.as.dead_zone, state, t);
    case HYST_PI:
        return prandtl_ishlinskii(stage, state, t);
    case HYST_RATE_DEPENDENT_PI:
        return rate_dependent_pi(stage.as.rate_dependent_pi, dt, state, t);
    case HYST_STATE_SPACE:
        return state_space_jacobian(stage.as.state_space, state,
                                    {t.signal, t.samples, t.rows, t.stride, t.incoming});
    case HYST_SECTIONS:
        return sections_jacobian(stage.as.sections, state,
                                 {t.signal, t.samples, t.rows, t.stride, t.incoming});
    case HYST_MASING:
        return masing_jacobian(stage.as.masing, state,
                               {t.signal, t.samples, t.rows, t.stride, t.incoming});
    case HYST_MEMORY_ELEMENT:
        return memory_element_jacobian(stage.as.memory_element, state,
                                       {t.signal, t.samples, t.rows, t.stride, t.incoming});
    }
}

}  // namespace

void jacobian(const Chain &chain, double *state, const double *u, std::size_t samples,
              double *jacobian) {
    std::vector<double> signal(u, u + samples);
    Tangents tangents{signal.data(), samples, jacobian, chain.parameter_count(), 0};
    for (std::size_t i = 0; i < chain.stages().size(); ++i) {
        const hyst_stage &stage = chain.stages()[i];
        pass(stage, chain.dt(i), state, tangents);
        tangents.incoming += parameter_count(stage);
        state += hyst_stage_state_length(&stage);
    }
}

}  // namespace hyst
