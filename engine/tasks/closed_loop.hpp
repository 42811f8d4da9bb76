// The loop of S1 Fig. 2 in one pass: linear blocks that are one state space, inverse, hysteresis.
#pragma once

#include <cstddef>
#include <vector>

#include "../chain.hpp"
#include "hyst/limited_tracking.h"
#include "hyst/repetitive_controller.h"
#include "hyst/tracking_controller.h"

namespace hyst {

// A record, stride 1, or a number for all samples, stride 0.
struct LoopInput {
    const double *values;
    std::size_t stride;
    double operator[](std::size_t k) const { return values[k * stride]; }
};

// What enters a loop and what comes out, N samples each.
struct LoopSignals {
    LoopInput r, noise;               // reference, measurement noise
    LoopInput before, behind;         // disturbances before the hysteresis and behind it
    double *v, *u, *eta, *y, *d_hat;  // eta: output of the hysteresis, behind not added
    std::size_t samples;
};

enum class LoopEnd { done, diverged, no_solution };

struct LoopResult {
    LoopEnd end;
    std::size_t samples;  // how many are good
    bool held = false;    // whether a limited drive was ever not that of the inverse
};

// Controller, observer and plant sampled as one system whose inputs are held:
//   [x+; v; y; d_hat] = step [x; r; noise; w],   u = inverse(v),   w = hysteresis(u + before) + behind
// step: (n + 3) rows of n + 3, row after row. Where v depends on w of the same sample, that equation
// is solved, or, with `delayed`, takes w of the sample before.
// A loop whose |y| passes `limit`, or one of whose signals is beyond all measure, has diverged.
LoopResult run_continuous_loop(std::size_t n, const double *step, bool delayed,
                               const Chain &inverse, const Chain &hysteresis,
                               std::vector<double> &inverse_state,
                               std::vector<double> &hysteresis_state, const LoopSignals &signals,
                               double limit);

// d_hat = e x + f [y_ref; y] of a sampled controller; e is null where it does not tell.
struct Estimate {
    const double *e;
    double f[2];
};

// A sampled controller around a plant [x+; y] = step [x; w], (n + 1) rows of n + 1. At sample k the
// controller is given y before its new drive acts: feedthrough of the plant shows w_{k-1}.
LoopResult run_sampled_loop(std::size_t n, const double *step,
                            const hyst_tracking_controller &controller, const Chain &inverse,
                            const Estimate &estimate, const Chain &hysteresis,
                            std::vector<double> &controller_state,
                            std::vector<double> &hysteresis_state, const LoopSignals &signals,
                            double limit);

// The same with a drive that is limited; v is the one that belongs to the drive applied.
LoopResult run_limited_loop(std::size_t n, const double *step,
                            const hyst_limited_tracking &controller, const Chain &hysteresis,
                            std::vector<double> &controller_state,
                            std::vector<double> &hysteresis_state, const LoopSignals &signals,
                            double limit);

// The same around a repetitive controller; `limited` where its drive has limits, else null.
LoopResult run_repetitive_loop(std::size_t n, const double *step,
                               const hyst_repetitive_memory &memory, const hyst_chain &inverse,
                               const hyst_limited_inverse *limited, const Chain &hysteresis,
                               std::vector<double> &controller_state,
                               std::vector<double> &hysteresis_state, const LoopSignals &signals,
                               double limit);

}  // namespace hyst
