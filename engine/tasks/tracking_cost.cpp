#include "tracking_cost.hpp"

#include <algorithm>
#include <cmath>

#include "rate_slope.hpp"

namespace hyst {
namespace {

double power_of(double x, unsigned power) {
    double result = 1.0;
    for (double square = x; power > 0; power /= 2, square *= square) {
        if (power % 2 == 1) result *= square;
    }
    return result;
}

}  // namespace

TrackedDrive::TrackedDrive(const TrackingGoal &goal, const double *drive)
    : goal_(goal), plays_(goal.model.pi.count), started_(goal.state[plays_ + 1] > 0.0),
      drive_(drive, drive + goal.samples), before_((goal.samples + 1) * plays_),
      term_(goal.samples, 0.0), now_(plays_), by_play_(plays_) {
    std::copy(goal.state, goal.state + plays_, before_.begin());
    growth(0, goal.samples, drive, 0, nullptr);
    accept();
}

double TrackedDrive::cost() const {
    double sum = 0.0;
    for (const double each : term_) sum += each;
    return sum;
}

double TrackedDrive::step(std::size_t k, double wanted) {
    const hyst_pi &pi = goal_.model.pi;
    const auto held = [&](std::size_t j) {
        return j >= first_ ? passed_[j - first_].held : drive_[j];
    };
    const bool has_last = k > 0 || started_;
    Passed s{};
    s.wanted = wanted;
    double u = std::min(std::max(wanted, goal_.terms.low), goal_.terms.high);
    const double last = k > 0 ? held(k - 1) : started_ ? goal_.state[plays_] : u;
    s.within = u == wanted;
    if (u > last + goal_.terms.change || u < last - goal_.terms.change) {
        u = u > last ? last + goal_.terms.change : last - goal_.terms.change;
        s.within = false;
        s.by_change = true;
    }
    s.held = u;
    const double change = u - last, rate = std::abs(change);
    const double widening = has_last ? hyst_widening(&goal_.model, rate) : 0.0;
    s.slope = change == 0.0 ? 0.0 : std::copysign(slope_of_widening(goal_.model, rate), change);
    const double low = u - widening, high = u + widening;
    double y = pi.p0 * u;
    for (std::size_t i = 0; i < plays_; ++i) {
        const double least = low - pi.r[i], most = high + pi.r[i];
        signed char touched = 0;
        if (now_[i] < least) {
            now_[i] = least;
            touched = -1;
        } else if (now_[i] > most) {
            now_[i] = most;
            touched = 1;
        }
        touched_.push_back(touched);
        after_.push_back(now_[i]);
        y += pi.p[i] * now_[i];
    }
    s.error = (y - goal_.target[k]) / goal_.terms.scale;
    s.term = power_of(s.error, goal_.terms.power);
    if (k > 1 && goal_.terms.roughness > 0.0) {
        s.bend = goal_.terms.roughness * (u - 2.0 * last + held(k - 2)) / goal_.terms.scale;
        s.term += power_of(s.bend, goal_.terms.power);
    }
    passed_.push_back(s);
    // How far it strayed is not kept with the sample: the drive that is accepted is held.
    return s.term + goal_.terms.stray * (wanted - u) * (wanted - u);
}

bool TrackedDrive::merged(std::size_t k) const {
    if (passed_.back().held != drive_[k]) return false;
    if (k > first_ && passed_[k - 1 - first_].held != drive_[k - 1]) return false;
    return std::equal(now_.begin(), now_.end(), &before_[(k + 1) * plays_]);
}

double TrackedDrive::growth(std::size_t first, std::size_t count, const double *samples,
                            std::size_t follow, double *gradient) {
    first_ = first;
    passed_.clear();
    after_.clear();
    touched_.clear();
    std::copy(&before_[first * plays_], &before_[first * plays_] + plays_, now_.begin());
    const std::size_t beyond = first + count;
    const std::size_t end = std::min(goal_.samples, beyond + std::min(follow, goal_.samples));
    double grown = 0.0;
    for (std::size_t k = first; k < end; ++k) {
        grown += step(k, k < beyond ? samples[k - first] : drive_[k]) - term_[k];
        if (k > beyond && merged(k)) break;
    }
    if (gradient != nullptr) back(count, gradient);
    return grown;
}

void TrackedDrive::back(std::size_t count, double *gradient) {
    const hyst_pi &pi = goal_.model.pi;
    by_held_.assign(passed_.size() + 2, 0.0);  // two samples before the first one
    std::fill(by_play_.begin(), by_play_.end(), 0.0);
    const double power = static_cast<double>(goal_.terms.power);
    for (std::size_t j = passed_.size(); j-- > 0;) {
        const Passed &s = passed_[j];
        const double by_y = power * power_of(s.error, goal_.terms.power - 1) / goal_.terms.scale;
        double by_now = by_held_[j + 2] + by_y * pi.p0, by_last = 0.0;
        for (std::size_t i = 0; i < plays_; ++i) {
            const double through = by_play_[i] + by_y * pi.p[i];
            const int touched = touched_[j * plays_ + i];
            if (touched == 0) {
                by_play_[i] = through;
                continue;
            }
            const double widened = touched * through * s.slope;
            by_now += through + widened;
            by_last -= widened;
            by_play_[i] = 0.0;
        }
        if (s.bend != 0.0) {
            const double bent =
                power * power_of(s.bend, goal_.terms.power - 1) * goal_.terms.roughness / goal_.terms.scale;
            by_now += bent;
            by_last -= 2.0 * bent;
            by_held_[j] += bent;
        }
        const double strayed = 2.0 * goal_.terms.stray * (s.wanted - s.held);
        by_now -= strayed;
        by_held_[j + 1] += by_last + (s.by_change ? by_now : 0.0);
        if (j < count) gradient[j] = strayed + (s.within ? by_now : 0.0);
    }
}

void TrackedDrive::accept() {
    for (std::size_t j = 0; j < passed_.size(); ++j) {
        drive_[first_ + j] = passed_[j].held;
        term_[first_ + j] = passed_[j].term;
    }
    std::copy(after_.begin(), after_.end(), &before_[(first_ + 1) * plays_]);
}

}  // namespace hyst
