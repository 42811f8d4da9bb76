// A limited-memory quasi-Newton descent for a function with corners.
//
// Directions of limited-memory BFGS, steps that fulfil the weak Wolfe conditions, found by halving
// and doubling: together they need a derivative nearly everywhere only, and go on down to where
// corners meet. Source: A. S. Lewis and M. L. Overton, Nonsmooth optimization via quasi-Newton
// methods, Mathematical Programming 141, 2013, secs. 3 and 5.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace hyst {

class QuasiNewton {
public:
    struct Found {
        double value;
        bool settled;  // nothing was left to gain; false if the steps ran out
    };

    QuasiNewton(std::size_t size, std::size_t memory)
        : n_(size), memory_(memory), moved_(memory * size), turned_(memory * size), rho_(memory),
          alpha_(memory), gradient_(size), direction_(size), x_(size), trial_(size),
          trial_gradient_(size) {}

    // From x down, which is where it ends; `reach` is the largest entry of the first step. Settled
    // where no step leads down or ten of them gain less than `least`.
    template <class Value>
    Found descend(Value &&value, double *x, double reach, std::size_t steps, double least) {
        constexpr std::size_t looked_at = 10;
        used_ = next_ = 0;
        std::copy(x, x + n_, x_.begin());
        double f = value(x_.data(), gradient_.data()), earlier = f;
        bool settled = false;
        for (std::size_t taken = 1; taken <= steps && !settled; ++taken) {
            point_down(reach);
            const double found = step(value, f);
            settled = !(found < f);
            if (!settled) f = found;
            if (taken % looked_at == 0) {
                settled = settled || earlier - f < least;
                earlier = f;
            }
        }
        std::copy(x_.begin(), x_.end(), x);
        return {f, settled};
    }

private:
    double dot(const double *a, const double *b) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < n_; ++i) sum += a[i] * b[i];
        return sum;
    }

    std::size_t back_by(std::size_t count) const { return (next_ + memory_ - count) % memory_; }

    void point_down(double reach) {
        along_memory(reach);
        if (used_ > 0 && !(dot(gradient_.data(), direction_.data()) < 0.0)) {
            used_ = 0;
            along_memory(reach);
        }
    }

    // The two loops over what is remembered; without memory the steepest way.
    void along_memory(double reach) {
        std::copy(gradient_.begin(), gradient_.end(), direction_.begin());
        for (std::size_t c = 1; c <= used_; ++c) {
            const std::size_t j = back_by(c);
            alpha_[j] = rho_[j] * dot(&moved_[j * n_], direction_.data());
            for (std::size_t i = 0; i < n_; ++i) direction_[i] -= alpha_[j] * turned_[j * n_ + i];
        }
        double unit = 0.0;
        if (used_ > 0) {
            const double *turned = &turned_[back_by(1) * n_];
            unit = 1.0 / (rho_[back_by(1)] * dot(turned, turned));
        } else {
            double steepest = 0.0;
            for (const double each : gradient_) steepest = std::max(steepest, std::abs(each));
            if (steepest > 0.0) unit = reach / steepest;
        }
        for (double &each : direction_) each *= unit;
        for (std::size_t c = used_; c > 0; --c) {
            const std::size_t j = back_by(c);
            const double beta = rho_[j] * dot(&turned_[j * n_], direction_.data());
            for (std::size_t i = 0; i < n_; ++i) {
                direction_[i] += (alpha_[j] - beta) * moved_[j * n_ + i];
            }
        }
        for (double &each : direction_) each = -each;
    }

    // Goes along the direction; gives f and stays where no step fulfils both conditions.
    template <class Value> double step(Value &&value, double f) {
        constexpr double enough = 1e-4, flat = 0.9;
        constexpr int most_tried = 30;
        const double slope = dot(gradient_.data(), direction_.data());
        if (!(slope < 0.0)) return f;
        double low = 0.0, high = std::numeric_limits<double>::infinity(), t = 1.0;
        for (int tried = 0; tried < most_tried; ++tried) {
            for (std::size_t i = 0; i < n_; ++i) trial_[i] = x_[i] + t * direction_[i];
            const double found = value(trial_.data(), trial_gradient_.data());
            if (!(found <= f + enough * t * slope)) {
                high = t;
            } else if (dot(trial_gradient_.data(), direction_.data()) < flat * slope) {
                low = t;
            } else {
                remember();
                return found;
            }
            t = std::isinf(high) ? 2.0 * low : 0.5 * (low + high);
        }
        return f;
    }

    void remember() {
        double *moved = &moved_[next_ * n_], *turned = &turned_[next_ * n_];
        for (std::size_t i = 0; i < n_; ++i) {
            moved[i] = trial_[i] - x_[i];
            turned[i] = trial_gradient_[i] - gradient_[i];
        }
        x_.swap(trial_);
        gradient_.swap(trial_gradient_);
        const double curvature = dot(moved, turned);
        if (!(curvature > 0.0)) return;
        rho_[next_] = 1.0 / curvature;
        next_ = (next_ + 1) % memory_;
        used_ = std::min(used_ + 1, memory_);
    }

    std::size_t n_, memory_, used_ = 0, next_ = 0;
    std::vector<double> moved_, turned_, rho_, alpha_;  // the memory: changes of x and of gradient
    std::vector<double> gradient_, direction_, x_, trial_, trial_gradient_;
};

}  // namespace hyst
