// What a drive of rate-dependent plays costs, and its exact derivative by every sample of the drive.
//
// Nothing is rounded here: plays and limits have the corners they have, and where the drive sits on
// one the derivative is that of one side. The drive is held within its limits as it is used: within
// its range first, then within its change per sample, sample after sample. A change of some samples
// of the drive is followed until the plays are back where they were, which is seldom far.
#pragma once

#include <cstddef>
#include <vector>

#include "hyst/rate_dependent_prandtl_ishlinskii.h"

namespace hyst {

// cost = sum_k phi(error_k / scale) + phi(roughness bend_k / scale) + stray (u_k - held_k)^2,
// phi(x) = x^power, bend_k = held_k - 2 held_{k-1} + held_{k-2} from the third sample on.
struct TrackingTerms {
    double low, high, change;  // limits; infinite ones do nothing
    unsigned power;            // even
    double scale;              // output units
    double roughness;          // output units per input unit
    double stray;              // per input unit squared
};

struct TrackingGoal {
    const hyst_rate_dependent_pi &model;
    const double *state;  // of the model before the record
    const double *target;
    std::size_t samples;
    TrackingTerms terms;
};

class TrackedDrive {
public:
    // Copies the drive, held within the limits.
    TrackedDrive(const TrackingGoal &goal, const double *drive);

    const std::vector<double> &drive() const { return drive_; }
    const TrackingGoal &goal() const { return goal_; }
    double cost() const;
    double term(std::size_t k) const { return term_[k]; }

    // By how much the cost would grow if samples first .. first + count - 1 of the drive were these;
    // followed for `follow` samples beyond them at most. Gradient: count derivatives, or null.
    double growth(std::size_t first, std::size_t count, const double *samples, std::size_t follow,
                  double *gradient);

    // Makes the samples of the last call of growth part of the drive.
    void accept();

private:
    double step(std::size_t k, double wanted);
    void back(std::size_t count, double *gradient);
    bool merged(std::size_t k) const;

    TrackingGoal goal_;
    std::size_t plays_;
    bool started_;
    // Of the drive: held samples, plays before every sample and after the last, costs of samples.
    std::vector<double> drive_, before_, term_;
    // Of the trial from sample first_ on: as above, and what the derivative needs.
    struct Passed {
        double wanted, held, error, bend, term, slope;
        bool within, by_change;
    };
    std::size_t first_ = 0;
    std::vector<Passed> passed_;
    std::vector<double> now_;         // plays
    std::vector<double> after_;       // plays after every sample
    std::vector<signed char> touched_;  // -1 at the lower bound, 1 at the upper, 0 between
    std::vector<double> by_held_, by_play_;
};

}  // namespace hyst
