#include "trajectory_polish.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "quasi_newton.hpp"

namespace hyst {
namespace {

constexpr std::size_t kMemory = 30;
constexpr double kPi = 3.141592653589793;

// Numbers in [0, 1), the same everywhere (the generator splitmix64).
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
    // Every factor as often as every other one.
    double between_sizes(double low, double high) {
        return low * std::exp(std::log(high / low) * next());
    }

private:
    std::uint64_t state_;
};

class Polisher {
public:
    Polisher(const TrackingGoal &goal, const Polish &how, const double *drive)
        : how_(how), tracked_(goal, drive), samples_(goal.samples),
          window_(std::min(std::max<std::size_t>(how.window, 1), goal.samples)),
          newton_(window_, std::min(window_, kMemory)), trial_(window_), numbers_(how.seed),
          share_(tracked_.cost() * static_cast<double>(window_) / static_cast<double>(samples_)) {}

    void every_window() {
        const std::size_t stride = std::max<std::size_t>(1, window_ / 2);
        for (std::size_t first = 0;; first = std::min(first + stride, samples_ - window_)) {
            take(first);
            descend(first);
            if (first + window_ >= samples_) return;
        }
    }

    // More of them where the cost is, some everywhere.
    void changed_windows() {
        std::vector<double> up_to(samples_);
        double sum = 0.0;
        for (std::size_t k = 0; k < samples_; ++k) up_to[k] = sum += tracked_.term(k);
        const double trials = static_cast<double>(how_.trials);
        const double window = static_cast<double>(window_);
        for (std::size_t j = 0; j < how_.trials; ++j) {
            const double share = (static_cast<double>(j) + numbers_.next()) / trials;
            double centre = share * static_cast<double>(samples_);
            if (numbers_.next() < 0.7) {
                const auto at = std::lower_bound(up_to.begin(), up_to.end(), share * sum);
                centre = static_cast<double>(at - up_to.begin()) +
                         window * numbers_.between(-0.25, 0.25);
            }
            const double start = std::max(0.0, centre - 0.5 * window);
            const std::size_t first = std::min(samples_ - window_, static_cast<std::size_t>(start));
            take(first);
            change(centre - static_cast<double>(first));
            descend(first);
        }
    }

    const TrackedDrive &tracked() const { return tracked_; }
    std::size_t cut_off() const { return cut_off_; }

private:
    void take(std::size_t first) {
        std::copy_n(&tracked_.drive()[first], window_, trial_.begin());
    }

    void change(double centre) {
        const double window = static_cast<double>(window_);
        const double width = numbers_.between_sizes(window / 64.0, window / 4.0);
        const double height =
            how_.size * numbers_.between(-2.0, 2.0) * numbers_.between_sizes(0.02, 1.0);
        const double kind = numbers_.next(), shift = numbers_.between(-4.0, 4.0);
        const std::vector<double> was = trial_;
        for (std::size_t k = 0; k < window_; ++k) {
            const double x = (static_cast<double>(k) - centre) / width;
            const double bump = std::exp(-0.5 * x * x);
            if (kind < 0.5) {
                trial_[k] += height * bump;
            } else if (kind < 0.7) {
                trial_[k] += height * bump * std::cos(kPi * x);
            } else {
                trial_[k] = between_samples(was, static_cast<double>(k) + shift * bump);
            }
        }
    }

    static double between_samples(const std::vector<double> &of, double at) {
        const double inside = std::min(std::max(at, 0.0), static_cast<double>(of.size() - 1));
        const auto low = static_cast<std::size_t>(inside);
        const std::size_t high = std::min(low + 1, of.size() - 1);
        return of[low] + (inside - static_cast<double>(low)) * (of[high] - of[low]);
    }

    // From the trial down, and kept if it ends lower than the drive, seen to the end of the record.
    void descend(std::size_t first) {
        const std::size_t end = std::min(samples_, first + window_ + how_.follow);
        double cost = 0.0;
        for (std::size_t k = first; k < end; ++k) cost += tracked_.term(k);
        const auto value = [&](const double *x, double *gradient) {
            return tracked_.growth(first, window_, x, how_.follow, gradient);
        };
        const QuasiNewton::Found found = newton_.descend(
            value, trial_.data(), 0.01 * how_.size, how_.steps, how_.least * std::max(cost, share_));
        cut_off_ += found.settled ? 0 : 1;
        if (found.value < 0.0 &&
            tracked_.growth(first, window_, trial_.data(), samples_, nullptr) < 0.0) {
            tracked_.accept();
        }
    }

    Polish how_;
    TrackedDrive tracked_;
    std::size_t samples_, window_;
    QuasiNewton newton_;
    std::vector<double> trial_;
    Numbers numbers_;
    double share_;  // a window's part of the cost, were it the same everywhere
    std::size_t cut_off_ = 0;
};

}  // namespace

Polished trajectory_polish(const TrackingGoal &goal, const Polish &how, double *drive) {
    if (goal.samples == 0) return {0.0, 0.0, 0};
    Polisher polisher(goal, how, drive);
    const double before = polisher.tracked().cost();
    if (how.trials == 0) {
        polisher.every_window();
    } else {
        polisher.changed_windows();
    }
    const std::vector<double> &found = polisher.tracked().drive();
    std::copy(found.begin(), found.end(), drive);
    return {before, polisher.tracked().cost(), polisher.cut_off()};
}

double tracking_gradient(const TrackingGoal &goal, const double *drive, double *gradient) {
    if (goal.samples == 0) return 0.0;
    TrackedDrive tracked(goal, drive);
    return tracked.cost() + tracked.growth(0, goal.samples, drive, 0, gradient);
}

}  // namespace hyst
