// Runs records through a chain, stage after stage, each by the engine that suits it.
//
// Invariant: the state after a record has the core's bits, whatever the engine. y has them too with
// the loop and with lanes; with the memory curve it agrees to rounding.
#pragma once

#include <cstddef>
#include <vector>

#include "../chain.hpp"
#include "cost_model.hpp"

namespace hyst {

struct Options {
    Engine engine = Engine::automatic;
    std::size_t threads = 1;
};

// What was chosen for one stage, and why. Costs are expected nanoseconds a sample; NaN where the
// engine cannot take the stage.
struct Choice {
    Engine engine;
    const char *reason;
    double loop, lanes, memory_curve;
    Roughness rough;
};

// What a stage is evaluated by if `wanted` is wanted; u is its input.
Choice choose(const Stage &stage, const double *state, const double *u, std::size_t samples,
              Engine wanted);

// `rows` records of `samples` each, one after the other in memory; states likewise. Returns the flat
// index of the first sample of u that is not finite, or else of the first whose way through the stages
// overflows, or rows * samples; in the first two cases states are as before and y is meaningless.
// u and y do not overlap. choices, if not null, receives one entry for each stage, for the first
// record, up to a stage that overflows.
std::size_t evaluate(const Chain &chain, double *states, const double *u, double *y,
                     std::size_t rows, std::size_t samples, const Options &options,
                     std::vector<Choice> *choices);

// A bank that the memory curve takes, from y into y. Returns false, and nothing is done, where a sample
// is not finite or so large that y may be left to the core, which needs what y held.
bool run_curve_in_place(const Stage &stage, double *state, double *y, std::size_t samples,
                        std::size_t threads);

// One stage, one record; u and y may be the same. Returns whether u and y were finite; if not, state
// and y are meaningless.
bool evaluate_stage(const Stage &stage, double *state, const double *u, double *y,
                    std::size_t samples, const Options &options);

}  // namespace hyst
