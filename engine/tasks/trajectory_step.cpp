#include "trajectory_step.hpp"

#include <algorithm>
#include <cmath>

#include "rate_slope.hpp"

namespace hyst {
namespace {

// max(x, 0) rounded over about `width`, and its slope.
struct Ramp {
    double value, slope;
};

Ramp rounded_ramp(double x, double width) {
    if (width == 0.0) return x > 0.0 ? Ramp{x, 1.0} : Ramp{0.0, 0.0};
    const double root = std::sqrt(x * x + width * width);
    return {0.5 * (x + root), 0.5 * (1.0 + x / root)};
}

// What one sample does to first order: z_i' = keep_i z_i + now_i u_k + before_i u_{k-1}.
struct Sample {
    double y, by_now, by_before;   // output, and its derivatives through u_k and u_{k-1}
    double bend;                   // u_k - 2 u_{k-1} + u_{k-2}
    double excess, change_excess;  // signed violation of the limits
    bool has_bend;
};

double excess_over(double value, double low, double high) {
    return value > high ? value - high : value < low ? value - low : 0.0;
}

// Walks through the record sample by sample with the rounded plays.
class Walk {
public:
    Walk(const TrajectoryTask &task, const double *u)
        : task_(task), u_(u), n_(task.model.pi.count), z_(task.state, task.state + n_),
          started_(task.state[n_ + 1] > 0.0) {}

    // keep, now, before: n derivatives each, or null.
    Sample next(double *keep, double *now, double *before) {
        const hyst_pi &pi = task_.model.pi;
        const double u = u_[k_];
        const bool has_before = k_ > 0 || started_;
        const double last = k_ > 0 ? u_[k_ - 1] : started_ ? task_.state[n_] : u;
        const double change = u - last, width = task_.rounding.rate;
        const double root = std::sqrt(change * change + width * width);
        const double widening = hyst_widening(&task_.model, root - width);
        const double side = root > 0.0 ? change / root : 0.0;
        const double slope =
            has_before ? side * slope_of_widening(task_.model, root - width) : 0.0;
        Sample s{pi.p0 * u, pi.p0, 0.0, 0.0, 0.0, 0.0, k_ > 1};
        for (std::size_t i = 0; i < n_; ++i) {
            const double low = u - widening - pi.r[i], high = u + widening + pi.r[i];
            const Ramp up = rounded_ramp(low - z_[i], task_.rounding.contact);
            const double raised = z_[i] + up.value;
            const Ramp down = rounded_ramp(raised - high, task_.rounding.contact);
            z_[i] = raised - down.value;
            s.y += pi.p[i] * z_[i];
            const double from_low = (1.0 - down.slope) * up.slope;
            const double by_now = from_low * (1.0 - slope) + down.slope * (1.0 + slope);
            const double by_before = (from_low - down.slope) * slope;
            s.by_now += pi.p[i] * by_now;
            s.by_before += pi.p[i] * by_before;
            if (keep != nullptr) {
                keep[i] = (1.0 - up.slope) * (1.0 - down.slope);
                now[i] = by_now;
                before[i] = by_before;
            }
        }
        if (s.has_bend) s.bend = u - 2.0 * last + u_[k_ - 2];
        s.excess = excess_over(u, task_.limits.low, task_.limits.high);
        if (has_before) {
            s.change_excess = excess_over(change, -task_.limits.change, task_.limits.change);
        }
        ++k_;
        return s;
    }

private:
    const TrajectoryTask &task_;
    const double *u_;
    std::size_t n_;
    std::vector<double> z_;
    bool started_;
    std::size_t k_ = 0;
};

// The quadratic value x' P x / 2 + q' x of what is still to come, seen from the state before a
// sample; going backwards over one sample gives its feedback step = offset + gain' x.
class Riccati {
public:
    explicit Riccati(std::size_t plays)
        : n_(plays), m_(plays + 2), P_(m_ * m_, 0.0), q_(m_, 0.0), Pv_(m_), Pb_(m_), next_(m_ * m_),
          by_state_(m_), cross_(m_) {}

    void back(const TrajectoryTask &task, std::size_t k, const Sample &s, const double *keep,
              const double *now, const double *before, double damping, double *gain,
              double *offset) {
        const double error = s.y - task.target[k];
        const double bend_weight = s.has_bend ? task.roughness : 0.0;
        const double range_weight = s.excess != 0.0 ? task.limits.penalty : 0.0;
        const double change_weight =
            s.change_excess != 0.0 && (k > 0 || task.state[n_ + 1] > 0.0) ? task.limits.penalty
                                                                          : 0.0;
        // P times the two dense columns: that of the input, and that of the previous input.
        for (std::size_t a = 0; a < m_; ++a) {
            double v = P_[a * m_ + n_], b = P_[a * m_ + n_ + 1];
            for (std::size_t i = 0; i < n_; ++i) {
                v += P_[a * m_ + i] * now[i];
                b += P_[a * m_ + i] * before[i];
            }
            Pv_[a] = v;
            Pb_[a] = b;
        }
        double vv = Pv_[n_], bb = Pb_[n_ + 1], bv = Pv_[n_ + 1];
        double qv = q_[n_], qb = q_[n_ + 1];
        for (std::size_t i = 0; i < n_; ++i) {
            vv += now[i] * Pv_[i];
            bb += before[i] * Pb_[i];
            bv += before[i] * Pv_[i];
            qv += now[i] * q_[i];
            qb += before[i] * q_[i];
        }
        const hyst_pi &pi = task.model.pi;
        for (std::size_t i = 0; i < n_; ++i) by_state_[i] = pi.p[i] * keep[i];
        by_state_[n_] = s.by_before;
        by_state_[n_ + 1] = 0.0;
        // Transition F' P F, F' P v, F' q: plays keep_i, previous input as above, the one before it
        // leaves the state.
        for (std::size_t i = 0; i < n_; ++i) {
            for (std::size_t j = 0; j < n_; ++j) {
                next_[i * m_ + j] = keep[i] * P_[i * m_ + j] * keep[j];
            }
            next_[i * m_ + n_] = next_[n_ * m_ + i] = keep[i] * Pb_[i];
            next_[i * m_ + n_ + 1] = next_[(n_ + 1) * m_ + i] = 0.0;
            cross_[i] = keep[i] * Pv_[i];
            q_[i] *= keep[i];
        }
        next_[n_ * m_ + n_] = bb;
        next_[n_ * m_ + n_ + 1] = next_[(n_ + 1) * m_ + n_] = 0.0;
        next_[(n_ + 1) * m_ + n_ + 1] = 0.0;
        cross_[n_] = bv;
        cross_[n_ + 1] = 0.0;
        q_[n_] = qb;
        q_[n_ + 1] = 0.0;
        // The costs of this sample: error, bend (1, -2, 1), range (1), change (1, -1).
        for (std::size_t a = 0; a < m_; ++a) {
            for (std::size_t b = 0; b < m_; ++b) next_[a * m_ + b] += by_state_[a] * by_state_[b];
            cross_[a] += s.by_now * by_state_[a];
            q_[a] += error * by_state_[a];
        }
        next_[n_ * m_ + n_] += 4.0 * bend_weight + change_weight;
        next_[n_ * m_ + n_ + 1] -= 2.0 * bend_weight;
        next_[(n_ + 1) * m_ + n_] -= 2.0 * bend_weight;
        next_[(n_ + 1) * m_ + n_ + 1] += bend_weight;
        cross_[n_] -= 2.0 * bend_weight + change_weight;
        cross_[n_ + 1] += bend_weight;
        q_[n_] -= 2.0 * bend_weight * s.bend + change_weight * s.change_excess;
        q_[n_ + 1] += bend_weight * s.bend;
        vv += s.by_now * s.by_now + bend_weight + range_weight + change_weight + damping;
        qv += s.by_now * error + bend_weight * s.bend + range_weight * s.excess +
              change_weight * s.change_excess;
        *offset = -qv / vv;
        for (std::size_t a = 0; a < m_; ++a) gain[a] = -cross_[a] / vv;
        for (std::size_t a = 0; a < m_; ++a) {
            for (std::size_t b = 0; b < m_; ++b) {
                P_[a * m_ + b] = next_[a * m_ + b] + cross_[a] * gain[b];
            }
            q_[a] += cross_[a] * *offset;
        }
    }

private:
    std::size_t n_, m_;
    std::vector<double> P_, q_, Pv_, Pb_, next_, by_state_, cross_;
};

double cost_of(const TrajectoryTask &task, const Sample &s, double error) {
    return error * error + (s.has_bend ? task.roughness * s.bend * s.bend : 0.0) +
           task.limits.penalty * (s.excess * s.excess + s.change_excess * s.change_excess);
}

}  // namespace

double trajectory_cost(const TrajectoryTask &task, const double *u) {
    Walk walk(task, u);
    double cost = 0.0;
    for (std::size_t k = 0; k < task.samples; ++k) {
        const Sample s = walk.next(nullptr, nullptr, nullptr);
        cost += cost_of(task, s, s.y - task.target[k]);
    }
    return cost;
}

double trajectory_step(const TrajectoryTask &task, const double *u, double damping, double *step) {
    const std::size_t n = task.model.pi.count, m = n + 2;
    std::vector<double> keep(task.samples * n), now(task.samples * n), before(task.samples * n);
    std::vector<double> gain(task.samples * m), offset(task.samples);
    std::vector<Sample> samples;
    samples.reserve(task.samples);
    Walk walk(task, u);
    for (std::size_t k = 0; k < task.samples; ++k) {
        samples.push_back(walk.next(&keep[k * n], &now[k * n], &before[k * n]));
    }
    Riccati riccati(n);
    for (std::size_t k = task.samples; k-- > 0;) {
        riccati.back(task, k, samples[k], &keep[k * n], &now[k * n], &before[k * n], damping,
                     &gain[k * m], &offset[k]);
    }
    std::vector<double> x(m, 0.0);
    double promise = 0.0;
    const hyst_pi &pi = task.model.pi;
    for (std::size_t k = 0; k < task.samples; ++k) {
        double v = offset[k];
        for (std::size_t a = 0; a < m; ++a) v += gain[k * m + a] * x[a];
        step[k] = v;
        Sample s = samples[k];
        const double error = s.y - task.target[k];
        promise += cost_of(task, s, error);
        double moved = s.by_now * v + s.by_before * x[n];
        for (std::size_t i = 0; i < n; ++i) {
            moved += pi.p[i] * keep[k * n + i] * x[i];
            x[i] = keep[k * n + i] * x[i] + now[k * n + i] * v + before[k * n + i] * x[n];
        }
        // Limits count as the linearised cost has them: only where they are violated now.
        s.bend += v - 2.0 * x[n] + x[n + 1];
        s.excess += s.excess != 0.0 ? v : 0.0;
        s.change_excess += s.change_excess != 0.0 ? v - x[n] : 0.0;
        promise -= cost_of(task, s, error + moved);
        x[n + 1] = x[n];
        x[n] = v;
    }
    return promise;
}

}  // namespace hyst
