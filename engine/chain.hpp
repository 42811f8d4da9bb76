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

// How a loading curve remembers; see core/include/hyst/masing.h.
struct MasingMemory {
    bool inverse, last_reversal;
    std::size_t depth;
    double dead_band;
};

// How a memory element remembers; see core/include/hyst/memory_element.h.
struct Momentum {
    bool inverse, absolute, is_reset;
    double reset_to;
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

    // A loading curve with memory of reversals. constants: c1 c2 c3 of a power law; p0 p_1.. r_1.. of
    // plays; a_1 .. a_n of a polynomial.
    void add_masing(hyst_curve_kind curve, std::vector<double> constants, double least_slope,
                    const MasingMemory &memory);
    // constants: c1 c2 c3; a_0 .. a_n; or the values of a table at `knots`. momentum: |u| or u.
    void add_memory_element(hyst_memory_kind function, std::vector<double> knots,
                            std::vector<double> constants, const Momentum &momentum, double dt);

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
