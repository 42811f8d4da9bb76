#include "closed_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "flat_chain.hpp"
#include "product.hpp"

namespace hyst {
namespace {

constexpr double kBeyondMeasure = 1e200;
constexpr int kMostDoublings = 200;

bool within(double limit, double y, double v, double u, double eta) {
    // A NaN fails every comparison.
    return std::fabs(y) <= limit && std::fabs(v) <= kBeyondMeasure &&
           std::fabs(u) <= kBeyondMeasure && std::fabs(eta) <= kBeyondMeasure;
}

// v -> w through inverse and hysteresis, with states of its own for trials.
class Actuator {
public:
    Actuator(const Chain &inverse, const Chain &hysteresis, std::vector<double> &inverse_state,
             std::vector<double> &hysteresis_state)
        : inverse_state_(inverse_state), hysteresis_state_(hysteresis_state),
          inverse_trial_(inverse_state), hysteresis_trial_(hysteresis_state),
          inverse_(inverse, inverse_state.data()), hysteresis_(hysteresis, hysteresis_state.data()),
          inverse_tried_(inverse, inverse_trial_.data()),
          hysteresis_tried_(hysteresis, hysteresis_trial_.data()) {}

    double drive(double v) { return inverse_.step(v); }
    double answer(double u) { return hysteresis_.step(u); }
    // What the answer to v would be; the states stay as they are.
    double trial(double v, double before) {
        std::copy(inverse_state_.begin(), inverse_state_.end(), inverse_trial_.begin());
        std::copy(hysteresis_state_.begin(), hysteresis_state_.end(), hysteresis_trial_.begin());
        return hysteresis_tried_.step(inverse_tried_.step(v) + before);
    }

private:
    std::vector<double> &inverse_state_, &hysteresis_state_;
    std::vector<double> inverse_trial_, hysteresis_trial_;
    FlatChain inverse_, hysteresis_, inverse_tried_, hysteresis_tried_;
};

// Root of a function that rises from minus to plus infinity, by the Illinois method: the hysteresis
// is piecewise smooth and Lipschitz, so secants close in quickly and the bracket never lets go.
template <typename Function>
bool rising_root(const Function &f, double start, double &root) {
    double low = start, high = start, f_low = f(start), f_high = f_low;
    if (!std::isfinite(f_low)) return false;
    double width = 1e-3 * (1.0 + std::fabs(start));
    for (int turn = 0; f_low > 0.0; ++turn, width *= 2.0) {
        if (turn == kMostDoublings) return false;
        high = low, f_high = f_low;
        low = start - width, f_low = f(low);
    }
    for (int turn = 0; f_high < 0.0; ++turn, width *= 2.0) {
        if (turn == kMostDoublings) return false;
        low = high, f_low = f_high;
        high = start + width, f_high = f(high);
    }
    int side = 0;
    for (int turn = 0; turn < 200 && f_low < 0.0 && f_high > 0.0; ++turn) {
        const double tolerance = 4e-16 * (std::fabs(low) + std::fabs(high));
        if (high - low <= tolerance) break;
        // Secants stall on a function that is nearly a step; every fourth turn halves the bracket.
        double v = turn % 4 == 3 ? 0.5 * (low + high)
                                 : (low * f_high - high * f_low) / (f_high - f_low);
        if (!(v > low && v < high)) v = 0.5 * (low + high);
        const double value = f(v);
        if (value < 0.0) {
            low = v, f_low = value;
            if (side < 0) f_high *= 0.5;
            side = -1;
        } else {
            high = v, f_high = value;
            if (value > 0.0 && side > 0) f_low *= 0.5;
            side = 1;
        }
    }
    root = f_high <= 0.0 || f_high < -f_low ? high : low;
    return true;
}

constexpr auto nothing = [](std::size_t) {};

// The linear part of a controller and its estimate, with the bits of hyst_tracking_controller_linear.
class LinearPart {
public:
    LinearPart(const hyst_tracking_controller &controller, const Estimate &estimate, const double *x)
        : order_(controller.order),
          product_(order_ + 2, order_ + 2,
                   [&](auto i, auto j) { return entry(controller, estimate, i, j); }),
          z_(2 + product_.rows(), 0.0), next_(z_) {
        std::copy_n(x, order_, z_.begin() + 2);
    }
    // v; NaN where something is not finite.
    double step(double y_ref, double y) {
        z_[0] = y_ref, z_[1] = y;
        double *const sums = &next_[2];
        product_.set(sums, z_.data(), order_ + 2, Begin::from_first);
        double zero = 0.0;  // unless something is not finite: then NaN
        for (std::size_t i = 0; i <= order_; ++i) zero += sums[i] - sums[i];
        z_.swap(next_);
        return zero == 0.0 ? sums[order_] : std::numeric_limits<double>::quiet_NaN();
    }
    double estimate() const { return z_[2 + order_ + 1]; }

private:
    // Rows: x+, v, d_hat. Columns: y_ref, y, x.
    static double entry(const hyst_tracking_controller &of, const Estimate &estimate, std::size_t i,
                        std::size_t j) {
        const std::size_t n = of.order;
        if (i < n) return j < 2 ? of.b[j * n + i] : of.a[(j - 2) * n + i];
        if (i == n) return j < 2 ? of.d[j] : of.c[j - 2];
        if (estimate.e == nullptr) return 0.0;
        return j < 2 ? estimate.f[j] : estimate.e[j - 2];
    }
    std::size_t order_;
    Product product_;
    std::vector<double> z_, next_;  // y_ref, y, x, v, d_hat; sums go into the other one
};

// A sampled controller, `answer`, from (y_ref, y) to u and v, around a plant.
// tell is called for each sample that is good.
template <typename Answer, typename Tell>
LoopResult run_around(std::size_t n, const double *step, const Answer &answer, const Tell &tell,
                      const Chain &hysteresis, std::vector<double> &hysteresis_state,
                      const LoopSignals &signals, double limit) {
    const Product product(n + 1, n + 1, [&](auto i, auto j) { return step[i * (n + 1) + j]; });
    const FlatChain actuator(hysteresis, hysteresis_state.data());
    // What is summed up is the next z, without a copy: processors wait for what they have just written
    // in pieces.
    std::vector<double> z(product.rows(), 0.0), next(z);
    for (std::size_t k = 0; k < signals.samples; ++k) {
        double y = product.at(n, n) * z[n];
        for (std::size_t j = 0; j < n; ++j) y += product.at(n, j) * z[j];
        double v = 0.0;
        const double u = answer(signals.r[k], y + signals.noise[k], v);
        const double eta = actuator.step(u + signals.before[k]);
        if (!within(limit, y, v, u, eta)) return {LoopEnd::diverged, k};
        signals.v[k] = v, signals.u[k] = u, signals.eta[k] = eta, signals.y[k] = y;
        tell(k);
        z[n] = eta + signals.behind[k];
        product.set(next.data(), z.data(), n + 1, Begin::from_zero);
        next[n] = z[n];
        z.swap(next);
    }
    return {LoopEnd::done, signals.samples};
}

}  // namespace

LoopResult run_continuous_loop(std::size_t n, const double *step, bool delayed,
                               const Chain &inverse, const Chain &hysteresis,
                               std::vector<double> &inverse_state,
                               std::vector<double> &hysteresis_state, const LoopSignals &signals,
                               double limit) {
    const Product product(n + 3, n + 3, [&](auto i, auto j) { return step[i * (n + 3) + j]; });
    Actuator actuator(inverse, hysteresis, inverse_state, hysteresis_state);
    std::vector<double> z(product.rows(), 0.0), sums(z);  // the sums are the next z
    const double feedthrough = product.at(n, n + 2);  // of w to v
    double w = 0.0, v_before = 0.0;
    for (std::size_t k = 0; k < signals.samples; ++k) {
        z[n] = signals.r[k], z[n + 1] = signals.noise[k];
        product.set(sums.data(), z.data(), n + 2, Begin::from_zero);
        const double before = signals.before[k], behind = signals.behind[k];
        double v = sums[n];
        if (feedthrough != 0.0 && delayed) {
            v += feedthrough * w;
        } else if (feedthrough != 0.0) {
            const auto unbalance = [&](double trial) {
                return trial - sums[n] - feedthrough * (actuator.trial(trial, before) + behind);
            };
            if (!rising_root(unbalance, v_before, v)) return {LoopEnd::no_solution, k};
        }
        const double u = actuator.drive(v), eta = actuator.answer(u + before);
        w = eta + behind;
        product.add_column(sums.data(), n + 2, w);
        if (!within(limit, sums[n + 1], v, u, eta)) return {LoopEnd::diverged, k};
        signals.v[k] = v, signals.u[k] = u, signals.eta[k] = eta;
        signals.y[k] = sums[n + 1], signals.d_hat[k] = sums[n + 2];
        z.swap(sums);
        v_before = v;
    }
    return {LoopEnd::done, signals.samples};
}

LoopResult run_sampled_loop(std::size_t n, const double *step,
                            const hyst_tracking_controller &controller, const Chain &inverse,
                            const Estimate &estimate, const Chain &hysteresis,
                            std::vector<double> &controller_state,
                            std::vector<double> &hysteresis_state, const LoopSignals &signals,
                            double limit) {
    LinearPart linear(controller, estimate, controller_state.data());
    const FlatChain drive(inverse, controller_state.data() + controller.order);
    const auto answer = [&](double y_ref, double y, double &v) {
        v = linear.step(y_ref, y);
        return drive.step(v);
    };
    double *d_hat = signals.d_hat;
    const auto tell = [&](std::size_t k) {
        if (estimate.e != nullptr) d_hat[k] = linear.estimate();
    };
    return run_around(n, step, answer, tell, hysteresis, hysteresis_state, signals, limit);
}

LoopResult run_limited_loop(std::size_t n, const double *step,
                            const hyst_limited_tracking &controller, const Chain &hysteresis,
                            std::vector<double> &controller_state,
                            std::vector<double> &hysteresis_state, const LoopSignals &signals,
                            double limit) {
    std::vector<double> before(controller_state.size());
    hyst_limited_guard guard = {{controller_state.back(), 0}, 0};
    double excess = 0.0;
    const auto answer = [&](double y_ref, double y, double &v) {
        return hyst_limited_tracking_step(&controller, controller_state.data(), before.data(),
                                          &guard, y_ref, y, &v, &excess);
    };
    LoopResult result =
        run_around(n, step, answer, nothing, hysteresis, hysteresis_state, signals, limit);
    result.held = guard.limited != 0;
    return result;
}

LoopResult run_repetitive_loop(std::size_t n, const double *step,
                               const hyst_repetitive_memory &memory, const hyst_chain &inverse,
                               const hyst_limited_inverse *limited, const Chain &hysteresis,
                               std::vector<double> &controller_state,
                               std::vector<double> &hysteresis_state, const LoopSignals &signals,
                               double limit) {
    std::vector<double> before(controller_state.size());
    hyst_limited_guard guard = {{limited == nullptr ? 0.0 : controller_state.back(), 0}, 0};
    int changed = 0;
    const auto answer = [&](double y_ref, double y, double &v) {
        return limited == nullptr
                   ? hyst_repetitive_step(&memory, &inverse, controller_state.data(), &guard.guard,
                                          y_ref, y, &v, &changed)
                   : hyst_limited_repetitive_step(&memory, limited, controller_state.data(),
                                                  before.data(), &guard, y_ref, y, &v, &changed);
    };
    LoopResult result =
        run_around(n, step, answer, nothing, hysteresis, hysteresis_state, signals, limit);
    result.held = guard.limited != 0;
    return result;
}

}  // namespace hyst
