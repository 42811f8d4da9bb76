// A chain of the core together with the memory its constants live in.
//
// Invariant: every stage points into `constants_`, which never moves after construction; so a Chain is
// neither copied nor moved.
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "hyst/chain.h"
#include "kinds/kinds.hpp"

namespace hyst {

// A stage as engines take it: the row of its kind, and its structure of the core.
struct Stage {
    const kinds::Kind *kind;
    const void *model;
    double dt;               // seconds; 0 where any will do
    std::size_t parameters;  // how many

    hyst_stage core() const { return {kind->core, model}; }
    std::size_t state_length() const { return kind->core->length(model); }
    // The core's own loop. u and y may be the same.
    void step_through(double *state, const double *u, double *y, std::size_t samples) const {
        const hyst_stage stage = core();
        hyst_stage_run(&stage, state, u, y, samples);
    }
};

// A bank of plays, which must outlive the stage.
inline Stage stage_of(const hyst_pi &bank) { return {&kinds::pi, &bank, 0.0, 1 + 2 * bank.count}; }

class Chain {
public:
    explicit Chain(const std::vector<kinds::Given> &stages);
    Chain(const Chain &) = delete;
    Chain &operator=(const Chain &) = delete;

    hyst_chain view() const { return {core_.size(), core_.data()}; }
    const std::vector<Stage> &stages() const { return stages_; }
    // What the operator says of stage i, and what the core is given of it.
    const kinds::Given &given(std::size_t i) const { return given_[i]; }
    const kinds::Constants &constants(std::size_t i) const { return constants_[i]; }
    std::size_t state_length() const;
    std::size_t parameter_count() const;

    // Other constants for the same stages, in the order of the operators' parameters, all stages one
    // after the other. Sizes, state and what is fixed stay.
    void set_parameters(const double *values);

    // One record; the state is carried in and out.
    void run(double *state, const double *u, double *y, std::size_t samples) const;

private:
    std::vector<kinds::Given> given_;
    std::deque<kinds::Constants> constants_;
    std::vector<Stage> stages_;
    std::vector<hyst_stage> core_;
};

}  // namespace hyst
