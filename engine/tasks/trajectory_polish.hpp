// Takes a drive down to a minimum of its tracking cost, window after window.
#pragma once

#include <cstddef>
#include <cstdint>

#include "tracking_cost.hpp"

namespace hyst {

struct Polish {
    std::size_t window;   // samples that change together
    std::size_t follow;   // samples beyond them that are followed while they do
    std::size_t trials;   // 0: every window once as it is; otherwise changed windows
    std::size_t steps;    // of a descent
    double least;         // share of the cost that ten steps have to gain
    double size;          // of changes tried, input units
    std::uint64_t seed;
};

struct Polished {
    double before, after;  // cost
    std::size_t accepted;
};

Polished trajectory_polish(const TrackingGoal &goal, const Polish &how, double *drive);

// The cost of a drive and its derivative.
double tracking_gradient(const TrackingGoal &goal, const double *drive, double *gradient);

}  // namespace hyst
