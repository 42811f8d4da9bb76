#include "trajectory_polish.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "quasi_newton.hpp"

namespace hyst {
namespace {

// Numbers in [0, 1), the same on every machine (splitmix64).
class Numbers {
public:
    explicit Numbers(std::uint64_t seed) : state_(seed) {}

    double next() {
        state_ += 0x9e3779b97f4a7c15u;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }
    double between(double low, double high) { return low + (high - low) * next(); }
    double spread(double low, double high) {
        return low * std::exp(std::log(high / low) * next());
    }

private:
    std::uint64_t state_;
};

class Polisher {
public:
    Polisher(const TrackingGoal &goal, const Polish &how, const double *drive)
        : how_(how), tracked_(goal, drive),
          window_(std::min(std::max<std::size_t>(how.window, 1), goal.samples)),
          newton_(window_, std::min<std::size_t>(window_, 30)), trial_(window_) {}

    std::size_t every_window() {
        const std::size_t samples = tracked_.goal().samples;
        const std::size_t stride = std::max<std::size_t>(1, window_ / 2);
        std::size_t accepted = 0;
        for (std::size_t first = 0;; first += stride) {
            first = std::min(first, samples - window_);
            take(first);
            accepted += descend(first, how_.steps);
            if (first + window_ >= samples) return accepted;
        }
    }

    std::size_t changed_windows() {
        Numbers numbers(how_.seed);
        const std::size_t samples = tracked_.goal().samples;
        std::vector<double> mass(samples);
        double sum = 0.0;
        for (std::size_t k = 0; k < samples; ++k) mass[k] = sum += tracked_.term(k);
        std::size_t accepted = 0;
        for (std::size_t j = 0; j < how_.trials; ++j) {
            const double share = (static_cast<double>(j) + numbers.next()) / static_cast<double>(how_.trials);
            double centre = share * static_cast<double>(samples);
            if (numbers.next() < 0.7) {
                const auto at = std::lower_bound(mass.begin(), mass.end(), share * sum);
                centre = static_cast<double>(at - mass.begin()) +
                         numbers.between(-0.25, 0.25) * static_cast<double>(window_);
            }
            const double start = centre - 0.5 * static_cast<double>(window_);
            const std::size_t first = std::min(
                samples - window_, static_cast<std::size_t>(std::max(0.0, start)));
            take(first);
            change(numbers, centre - static_cast<double>(first));
            accepted += descend(first, how_.steps);
        }
        return accepted;
    }

    const std::vector<double> &drive() const { return tracked_.drive(); }
    double cost() const { return tracked_.cost(); }

private:
    void take(std::size_t first) {
        std::copy_n(&tracked_.drive()[first], window_, trial_.begin());
    }

    void change(Numbers &numbers, double centre) {
        const double window = static_cast<double>(window_);
        const double width = numbers.spread(window / 64.0, window / 4.0);
        const double height = numbers.between(-2.0, 2.0) * numbers.spread(0.02, 1.0) * how_.size;
        const double kind = numbers.next(), shift = numbers.between(-4.0, 4.0);
        const std::vector<double> was = trial_;
        for (std::size_t k = 0; k < window_; ++k) {
            const double x = (static_cast<double>(k) - centre) / width;
            const double bump = std::exp(-0.5 * x * x);
            if (kind < 0.5) {
                trial_[k] += height * bump;
            } else if (kind < 0.7) {
                trial_[k] += height * bump * std::cos(3.14159265358979 * x);
            } else {
                const double at = std::min(std::max(static_cast<double>(k) + shift * bump, 0.0), window - 1.0);
                const std::size_t low = std::min(static_cast<std::size_t>(at), window_ - 1);
                const std::size_t high = std::min(low + 1, window_ - 1);
                const double part = at - static_cast<double>(low);
                trial_[k] = was[low] + part * (was[high] - was[low]);
            }
        }
    }

    bool descend(std::size_t first, std::size_t steps) {
        double base = 0.0;
        const std::size_t samples = tracked_.goal().samples;
        const std::size_t end = std::min(samples, first + window_ + how_.follow);
        for (std::size_t k = first; k < end; ++k) base += tracked_.term(k);
        const auto value = [&](const double *x, double *gradient) {
            return tracked_.growth(first, window_, x, how_.follow, gradient);
        };
        const double least = how_.least * base;
        const double grown =
            newton_.descend(value, trial_.data(), base, 0.01 * how_.size, steps, least);
        if (!(grown < 0.0)) return false;
        // To the end of what it changes.
        if (!(tracked_.growth(first, window_, trial_.data(), samples, nullptr) < 0.0)) return false;
        tracked_.accept();
        return true;
    }

    Polish how_;
    TrackedDrive tracked_;
    std::size_t window_;
    QuasiNewton newton_;
    std::vector<double> trial_;
};

}  // namespace

Polished trajectory_polish(const TrackingGoal &goal, const Polish &how, double *drive) {
    Polisher polisher(goal, how, drive);
    Polished result{polisher.cost(), 0.0, 0};
    result.accepted = how.trials == 0 ? polisher.every_window() : polisher.changed_windows();
    result.after = polisher.cost();
    std::copy(polisher.drive().begin(), polisher.drive().end(), drive);
    return result;
}

double tracking_gradient(const TrackingGoal &goal, const double *drive, double *gradient) {
    TrackedDrive tracked(goal, drive);
    const double cost = tracked.cost();
    return cost + tracked.growth(0, goal.samples, drive, 0, gradient);
}

}  // namespace hyst
