#include "closed_loop.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace hyst {
namespace {

constexpr double kBeyondMeasure = 1e200;
constexpr int kMostDoublings = 200;

bool within(double limit, double y, double v, double u, double eta) {
    // A NaN fails every comparison.
    return std::fabs(y) <= limit && std::fabs(v) <= kBeyondMeasure &&
           std::fabs(u) <= kBeyondMeasure && std::fabs(eta) <= kBeyondMeasure;
}

// sums += columns times z, for rows known to the compiler: the sums stay in registers, which takes
// half the time of loops whose short length is only known when they run.
template <std::size_t rows>
void accumulate(const double *columns, std::size_t, const double *z, std::size_t count,
                double *sums) {
    double held[rows];
    std::copy_n(sums, rows, held);
    for (std::size_t j = 0; j < count; ++j, columns += rows) {
        for (std::size_t i = 0; i < rows; ++i) held[i] += columns[i] * z[j];
    }
    std::copy_n(held, rows, sums);
}

void accumulate_any(const double *columns, std::size_t rows, const double *z, std::size_t count,
                    double *sums) {
    for (std::size_t j = 0; j < count; ++j, columns += rows) {
        for (std::size_t i = 0; i < rows; ++i) sums[i] += columns[i] * z[j];
    }
}

// step times z, column after column: the sums of all rows run side by side. Rows of zeros fill up
// to a multiple of four, so sums has rows() entries.
class Product {
public:
    Product(std::size_t rows, std::size_t columns, const double *row_after_row)
        : rows_((rows + 3) / 4 * 4), values_(rows_ * columns, 0.0) {
        for (std::size_t i = 0; i < rows; ++i) {
            for (std::size_t j = 0; j < columns; ++j) {
                values_[j * rows_ + i] = row_after_row[i * columns + j];
            }
        }
        constexpr Accumulate known[] = {accumulate<4>, accumulate<8>, accumulate<12>,
                                        accumulate<16>, accumulate<20>};
        const std::size_t fours = rows_ / 4 - 1;
        accumulate_ = fours < std::size(known) ? known[fours] : accumulate_any;
    }
    std::size_t rows() const { return rows_; }
    double at(std::size_t i, std::size_t j) const { return values_[j * rows_ + i]; }
    void clear_and_add(double *sums, const double *z, std::size_t count) const {
        std::fill_n(sums, rows_, 0.0);
        accumulate_(values_.data(), rows_, z, count, sums);
    }
    void add_column(double *sums, std::size_t j, double z) const {
        accumulate_(values_.data() + j * rows_, rows_, &z, 1, sums);
    }

private:
    using Accumulate = void (*)(const double *, std::size_t, const double *, std::size_t, double *);
    std::size_t rows_;
    std::vector<double> values_;
    Accumulate accumulate_;
};

// v -> w through inverse and hysteresis, with states of its own for trials.
class Actuator {
public:
    Actuator(const Chain &inverse, const Chain &hysteresis, std::vector<double> &inverse_state,
             std::vector<double> &hysteresis_state)
        : inverse_(inverse.view()), hysteresis_(hysteresis.view()), inverse_state_(inverse_state),
          hysteresis_state_(hysteresis_state), inverse_trial_(inverse_state),
          hysteresis_trial_(hysteresis_state) {}

    double drive(double v) { return hyst_chain_step(&inverse_, inverse_state_.data(), v); }
    double answer(double u) { return hyst_chain_step(&hysteresis_, hysteresis_state_.data(), u); }
    // What the answer to v would be; the states stay as they are.
    double trial(double v, double before) {
        std::copy(inverse_state_.begin(), inverse_state_.end(), inverse_trial_.begin());
        std::copy(hysteresis_state_.begin(), hysteresis_state_.end(), hysteresis_trial_.begin());
        const double u = hyst_chain_step(&inverse_, inverse_trial_.data(), v);
        return hyst_chain_step(&hysteresis_, hysteresis_trial_.data(), u + before);
    }

private:
    hyst_chain inverse_, hysteresis_;
    std::vector<double> &inverse_state_, &hysteresis_state_;
    std::vector<double> inverse_trial_, hysteresis_trial_;
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

// A sampled controller, `answer`, from (y_ref, y) to u and v, around a plant.
template <typename Answer>
LoopResult run_around(std::size_t n, const double *step, const Answer &answer,
                      const Chain &hysteresis, std::vector<double> &hysteresis_state,
                      const LoopSignals &signals, double limit) {
    const Product product(n + 1, n + 1, step);
    const hyst_chain plant_hysteresis = hysteresis.view();
    std::vector<double> z(n + 1, 0.0), sums(product.rows(), 0.0);
    for (std::size_t k = 0; k < signals.samples; ++k) {
        double y = product.at(n, n) * z[n];
        for (std::size_t j = 0; j < n; ++j) y += product.at(n, j) * z[j];
        double v = 0.0;
        const double u = answer(signals.r[k], y + signals.noise[k], v);
        const double eta = hyst_chain_step(&plant_hysteresis, hysteresis_state.data(),
                                           u + signals.before[k]);
        if (!within(limit, y, v, u, eta)) return {LoopEnd::diverged, k};
        signals.v[k] = v, signals.u[k] = u, signals.eta[k] = eta, signals.y[k] = y;
        z[n] = eta + signals.behind[k];
        product.clear_and_add(sums.data(), z.data(), n + 1);
        std::copy_n(sums.begin(), n, z.begin());
    }
    return {LoopEnd::done, signals.samples};
}

}  // namespace

LoopResult run_continuous_loop(std::size_t n, const double *step, bool delayed,
                               const Chain &inverse, const Chain &hysteresis,
                               std::vector<double> &inverse_state,
                               std::vector<double> &hysteresis_state, const LoopSignals &signals,
                               double limit) {
    const Product product(n + 3, n + 3, step);
    Actuator actuator(inverse, hysteresis, inverse_state, hysteresis_state);
    std::vector<double> z(n + 2, 0.0), sums(product.rows(), 0.0);
    const double feedthrough = product.at(n, n + 2);  // of w to v
    double w = 0.0, v_before = 0.0;
    for (std::size_t k = 0; k < signals.samples; ++k) {
        z[n] = signals.r[k], z[n + 1] = signals.noise[k];
        product.clear_and_add(sums.data(), z.data(), n + 2);
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
        std::copy_n(sums.begin(), n, z.begin());
        v_before = v;
    }
    return {LoopEnd::done, signals.samples};
}

LoopResult run_sampled_loop(std::size_t n, const double *step,
                            const hyst_tracking_controller &controller, const Chain &hysteresis,
                            std::vector<double> &controller_state,
                            std::vector<double> &hysteresis_state, const LoopSignals &signals,
                            double limit) {
    double *const x = controller_state.data(), *const memory = x + controller.order;
    const auto answer = [&](double y_ref, double y, double &v) {
        v = hyst_tracking_controller_linear(&controller, x, y_ref, y);
        return hyst_chain_step(&controller.inverse, memory, v);
    };
    return run_around(n, step, answer, hysteresis, hysteresis_state, signals, limit);
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
        run_around(n, step, answer, hysteresis, hysteresis_state, signals, limit);
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
        run_around(n, step, answer, hysteresis, hysteresis_state, signals, limit);
    result.held = guard.limited != 0;
    return result;
}

}  // namespace hyst
