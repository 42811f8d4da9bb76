// Time lanes: a record cut into stretches that are evaluated side by side, each starting from the
// exact memory that the stretches before it leave. docs/engine.md says why that is exact.
//
// Invariant: state and y get the bits of the core's loop.
#pragma once

#include <cstddef>

#include "../chain.hpp"

namespace hyst {

class Lanes {
public:
    // Whether the lane identity holds for this stage: plays of thresholds that ascend from >= 0.
    static bool can_take(const Stage &stage);

    // The stage, which can_take, must outlive this.
    explicit Lanes(const Stage &stage) : stage_(stage) {}

    // The state after `count` more samples, without their outputs.
    void jump(double *state, const double *u, std::size_t count) const;

    // One record. u and y may be the same. Returns false if u or y was not finite; state and y are
    // then meaningless.
    bool run(double *state, const double *u, double *y, std::size_t samples) const;

    // As many records as there are lanes, one after the other in memory, and their states.
    bool run_rows(double *states, const double *u, double *y, std::size_t samples) const;

private:
    bool run_packed(double *packed, const double *u, double *y, std::size_t samples,
                    std::size_t stride) const;

    const Stage &stage_;
};

}  // namespace hyst
