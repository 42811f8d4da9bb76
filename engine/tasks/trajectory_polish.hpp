// Takes a drive of rate-dependent plays down to a minimum of its tracking cost, window by window.
//
// In a window some samples of the drive change together, those around it stay: a descent with the
// exact derivative costs what the window costs, however long the record. The tracking cost has many
// local minima; a trial changes a window first (a bump, a ripple, a shift in time, by numbers that
// are the same at every call) and is kept where it ends lower.
#pragma once

#include <cstddef>
#include <cstdint>

#include "tracking_cost.hpp"

namespace hyst {

struct Polish {
    std::size_t window;  // samples
    std::size_t follow;  // samples beyond them whose cost a descent sees
    std::size_t trials;  // 0: every window from where it is
    std::size_t steps;   // of a descent
    double least;        // share of a window's cost, or of that of a mean one if that is larger, that
                         // ten steps must gain to go on
    double size;         // of the changes tried, input units
    std::uint64_t seed;
};

struct Polished {
    double before, after;  // cost
    std::size_t cut_off;   // windows whose steps ran out
};

Polished trajectory_polish(const TrackingGoal &goal, const Polish &how, double *drive);

// The cost of a drive; writes its derivative by every sample.
double tracking_gradient(const TrackingGoal &goal, const double *drive, double *gradient);

}  // namespace hyst
