// A chain of the core together with the memory its constants live in.
//
// Invariant: every pointer inside `stages_` points into `constants_`, which never moves after
// construction; so a Chain is neither copied nor moved.
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "hyst/hyst.h"

namespace hyst {

// Widening of the thresholds over the rate x of the input, in units per second:
// beta x + powers_0 x^2 + powers_1 x^3 + .. + sum_j slopes_j max(x - knees_j, 0).
struct RateCurve {
    double beta;
    std::vector<double> powers, slopes, knees;
};

class Chain {
public:
    Chain() = default;
    Chain(const Chain &) = delete;
    Chain &operator=(const Chain &) = delete;

    void add_affine(double gain, double offset);
    void add_play(double r);
    void add_stop(double r);
    void add_dead_zone(std::vector<double> weights, std::vector<double> thresholds,
                       bool by_direction);
    void add_pi(double p0, std::vector<double> p, std::vector<double> r);
    void add_rate_dependent_pi(double p0, std::vector<double> p, std::vector<double> r,
                               const RateCurve &curve, double dt);
    // a: order x order, column after column.
    void add_state_space(std::size_t delay, std::vector<double> a, std::vector<double> b,
                         std::vector<double> c, double d);
    // Five coefficients for each section: b0 b1 b2 a1 a2.
    void add_sections(std::vector<double> coefficients);

    hyst_chain view() const { return {stages_.size(), stages_.data()}; }
    const std::vector<hyst_stage> &stages() const { return stages_; }
    // Sample time of stage i in seconds; 0 where the stage has none.
    double dt(std::size_t i) const { return dts_.size() > i ? dts_[i] : 0.0; }
    std::size_t state_length() const;
    std::size_t parameter_count() const;

    // One record; the state is carried in and out.
    void run(double *state, const double *u, double *y, std::size_t samples) const;

private:
    const double *keep(std::vector<double> values);

    std::deque<std::vector<double>> constants_;
    std::vector<hyst_stage> stages_;
    std::vector<double> dts_;
};

// Parameters of one stage in the order of Operator.parameters() in Python.
std::size_t parameter_count(const hyst_stage &stage);

}  // namespace hyst
