// Limited-memory BFGS with a weak Wolfe search along the line: it needs a derivative nearly
// everywhere only, and goes down to where corners meet (Lewis and Overton, 2013).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace hyst {

class QuasiNewton {
public:
    QuasiNewton(std::size_t size, std::size_t memory)
        : n_(size), memory_(memory), s_(memory * size), y_(memory * size), rho_(memory),
          alpha_(memory), g_(size), d_(size), x_(size), trial_(size), trial_g_(size) {}

    // From x down: reach is the size of the first step. Stops where `patience` steps together gain
    // less than `least`, or after `steps`. Returns the value; x is where it is.
    template <class Value>
    double descend(Value &&value, double *x, double start, double reach, std::size_t steps,
                   double least) {
        constexpr std::size_t patience = 10;
        used_ = next_ = 0;
        std::copy(x, x + n_, x_.begin());
        double f = value(x_.data(), g_.data()), earlier = f;
        (void)start;
        for (std::size_t taken = 0; taken < steps; ++taken) {
            direction(reach);
            const double moved = along(value, f);
            if (!(moved < f)) break;
            f = moved;
            if (taken % patience == patience - 1) {
                if (earlier - f < least) break;
                earlier = f;
            }
        }
        std::copy(x_.begin(), x_.end(), x);
        return f;
    }

private:
    static double dot(const double *a, const double *b, std::size_t n) {
        double sum = 0.0;
        for (std::size_t i = 0; i < n; ++i) sum += a[i] * b[i];
        return sum;
    }

    void direction(double reach) {
        std::copy(g_.begin(), g_.end(), d_.begin());
        for (std::size_t c = 0; c < used_; ++c) {
            const std::size_t j = (next_ + memory_ - 1 - c) % memory_;
            alpha_[j] = rho_[j] * dot(&s_[j * n_], d_.data(), n_);
            for (std::size_t i = 0; i < n_; ++i) d_[i] -= alpha_[j] * y_[j * n_ + i];
        }
        double unit;
        if (used_ > 0) {
            const std::size_t j = (next_ + memory_ - 1) % memory_;
            unit = 1.0 / (rho_[j] * dot(&y_[j * n_], &y_[j * n_], n_));
        } else {
            double steepest = 0.0;
            for (const double each : g_) steepest = std::max(steepest, std::abs(each));
            unit = steepest > 0.0 ? reach / steepest : 0.0;
        }
        for (double &each : d_) each *= unit;
        for (std::size_t c = used_; c-- > 0;) {
            const std::size_t j = (next_ + memory_ - 1 - c) % memory_;
            const double beta = rho_[j] * dot(&y_[j * n_], d_.data(), n_);
            for (std::size_t i = 0; i < n_; ++i) d_[i] += (alpha_[j] - beta) * s_[j * n_ + i];
        }
        for (double &each : d_) each = -each;
        if (!(dot(g_.data(), d_.data(), n_) < 0.0) && used_ > 0) {
            used_ = 0;
            direction(reach);
        }
    }

    template <class Value> double along(Value &&value, double f) {
        const double slope = dot(g_.data(), d_.data(), n_);
        if (!(slope < 0.0)) return f;
        double low = 0.0, high = std::numeric_limits<double>::infinity(), t = 1.0;
        double best = f;
        for (int tried = 0; tried < 30; ++tried) {
            for (std::size_t i = 0; i < n_; ++i) trial_[i] = x_[i] + t * d_[i];
            const double found = value(trial_.data(), trial_g_.data());
            if (!(found <= f + 1e-4 * t * slope)) {
                high = t;
            } else if (dot(trial_g_.data(), d_.data(), n_) < 0.9 * slope) {
                low = t;
            } else {
                best = found;
                break;
            }
            t = high < std::numeric_limits<double>::infinity() ? 0.5 * (low + high) : 2.0 * low;
        }
        if (!(best < f)) return f;
        double *s = &s_[next_ * n_], *y = &y_[next_ * n_];
        for (std::size_t i = 0; i < n_; ++i) {
            s[i] = trial_[i] - x_[i];
            y[i] = trial_g_[i] - g_[i];
        }
        const double curvature = dot(s, y, n_);
        x_.swap(trial_);
        g_.swap(trial_g_);
        if (curvature > 0.0) {
            rho_[next_] = 1.0 / curvature;
            next_ = (next_ + 1) % memory_;
            used_ = std::min(used_ + 1, memory_);
        }
        return best;
    }

    std::size_t n_, memory_, used_ = 0, next_ = 0;
    std::vector<double> s_, y_, rho_, alpha_, g_, d_, x_, trial_, trial_g_;
};

}  // namespace hyst
