// One sample's equation in the change d = u_k - u_{k-1} is continuous, and for a linear rate curve
// it is straight between the points where a bound meets a play. So the roots are found by walking
// outwards over those points on either side of d = 0. For a curved rate curve the points are a grid
// that doubles, and the root between two of them is found by bisection.
#include "sample_exact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace hyst {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

class SampleEquation {
public:
    explicit SampleEquation(const hyst_rate_dependent_pi &model)
        : model_(model), trial_(model.pi.count + 2) {}

    void at(const double *state, double target) {
        state_ = state;
        target_ = target;
        base_ = state[model_.pi.count + 1] > 0.0 ? state[model_.pi.count] : 0.0;
    }

    double base() const { return base_; }

    double miss(double change) {
        std::copy(state_, state_ + trial_.size(), trial_.begin());
        return hyst_rate_dependent_pi_step(&model_, trial_.data(), base_ + change) - target_;
    }

    // Distances from d = 0, ascending, at which the equation bends on one side (+1 or -1).
    void bends(double side, std::vector<double> &at) const {
        at.clear();
        const bool moves = state_[model_.pi.count + 1] > 0.0;
        const double growth = moves ? model_.growth : 0.0;
        for (std::size_t i = 0; i < model_.pi.count; ++i) {
            const double apart = state_[i] - base_, r = model_.pi.r[i];
            add((apart + r) / (side - growth), at);
            add((apart - r) / (side + growth), at);
        }
        if (model_.powers > 0 || model_.ramps.count > 0) {
            const double size = 1.0 + std::fabs(base_) + std::fabs(target_);
            for (double t = 1e-9 * size; t < 1e6 * size; t *= 1.25) at.push_back(t);
        }
        std::sort(at.begin(), at.end());
    }

    // Root between two points of opposite miss. Straight or not, it is exact to rounding.
    double root(double a, double miss_a, double b, double miss_b) {
        for (int pass = 0; pass < 200 && std::fabs(b - a) > 0.0; ++pass) {
            double c = a - miss_a * (b - a) / (miss_b - miss_a);
            if (pass > 3 || !(std::min(a, b) <= c && c <= std::max(a, b))) c = 0.5 * (a + b);
            if (c == a || c == b) break;
            const double miss_c = miss(c);
            if (miss_c == 0.0) return c;
            if ((miss_c > 0.0) == (miss_a > 0.0)) {
                a = c;
                miss_a = miss_c;
            } else {
                b = c;
                miss_b = miss_c;
            }
        }
        return std::fabs(miss_a) < std::fabs(miss_b) ? a : b;
    }

private:
    static void add(double t, std::vector<double> &at) {
        if (t > 0.0 && t < none) at.push_back(t);
    }

    const hyst_rate_dependent_pi &model_;
    std::vector<double> trial_;
    const double *state_ = nullptr;
    double target_ = 0.0, base_ = 0.0;
};

// Nearest root on one side, or infinity; counts all roots there.
double nearest(SampleEquation &equation, double side, double miss_at_0, std::vector<double> &at,
               std::size_t &roots) {
    equation.bends(side, at);
    double found = none, a = 0.0, miss_a = miss_at_0;
    const auto look = [&](double b) {
        const double miss_b = equation.miss(side * b);
        if (miss_b == 0.0 || (miss_a != 0.0 && (miss_a > 0.0) != (miss_b > 0.0))) {
            ++roots;
            if (found == none) found = equation.root(side * a, miss_a, side * b, miss_b);
        }
        a = b;
        miss_a = miss_b;
    };
    for (double b : at) look(b);
    // Beyond the last bend the line goes on; see where it would cross, and look a little further.
    const double step = 1.0 + a, slope = (equation.miss(side * (a + step)) - miss_a) / step;
    if (slope != 0.0 && miss_a / slope < 0.0) look(a - 1.5 * miss_a / slope);
    return found;
}

}  // namespace

SampleExact sample_exact(const hyst_rate_dependent_pi &model, double *state, const double *target,
                         double *u, std::size_t samples, double low, double high) {
    SampleExact result{0, 0};
    SampleEquation equation(model);
    std::vector<double> at;
    for (std::size_t k = 0; k < samples; ++k) {
        equation.at(state, target[k]);
        const double miss_at_0 = equation.miss(0.0);
        std::size_t roots = miss_at_0 == 0.0;
        double change = 0.0;
        if (miss_at_0 != 0.0) {
            const double up = nearest(equation, 1.0, miss_at_0, at, roots);
            const double down = nearest(equation, -1.0, miss_at_0, at, roots);
            if (roots == 0) return result;
            change = std::fabs(up) <= std::fabs(down) ? up : down;
        }
        result.several += roots > 1;
        u[k] = std::min(std::max(equation.base() + change, low), high);
        hyst_rate_dependent_pi_step(&model, state, u[k]);
        ++result.solved;
    }
    return result;
}

}  // namespace hyst
