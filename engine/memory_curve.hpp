// The memory of all plays at once, as the curve r -> z(r): cost per sample independent of how many
// plays there are.
//
// Invariant: plays ascend by r. From the smallest on, the stack's top segment first, plays
// [segment above's end, segment's end) hold z = e - r where a rising input last left them, or
// z = e + r where a falling one did; plays from the lowest segment's end on hold what they held at
// the start. A rising input pushes the smallest plays, up to the first whose z + r it does not
// reach. So the output is a + b u until the next play, or the next segment, is reached.
// Sums over the plays of a segment are differences of prefix sums of p and p r; y therefore agrees
// with the core's sum in order to rounding, not to the bit. The memory itself is not read from
// here but from the jump (lanes.hpp), which is exact.
#pragma once

#include <cstddef>
#include <vector>

#include "hyst/prandtl_ishlinskii.h"
#include "simd/kernels.hpp"

namespace hyst {

// Whether z is a memory an input can have left: |z_{i+1} - z_i| <= r_{i+1} - r_i, to rounding.
bool is_admissible(const hyst_pi &pi, const double *z);

class MemoryCurve {
public:
    // pi, with its thresholds ascending from >= 0 and at least one play, and z, admissible, must
    // outlive this.
    MemoryCurve(const hyst_pi &pi, const double *z);

    // The next samples; y may not be u. Returns how many were finite and have been taken.
    std::size_t run(const double *u, double *y, std::size_t count);

private:
    enum Way { kRising = 1, kFalling = -1 };

    struct Segment {
        double e;         // the input that left it
        Way way;          // how that input moved: z = e - way r
        std::size_t end;  // first play beyond it
        double tail;      // sum of p z over the plays beyond it
    };

    template <Way way>
    Line turn(double u);
    template <Way way>
    Line settle_on_start(double u, std::size_t first);
    Line move_to(double u);
    double sum_from(const Segment &segment, std::size_t first) const;
    std::size_t first_not_passed(double distance, std::size_t first, std::size_t end) const;
    void build_index();

    const hyst_pi &pi_;
    const double *z_;
    std::vector<double> p_sum_;     // of the first i weights
    std::vector<double> pr_sum_;    // of the first i products p r
    std::vector<double> start_sum_; // of p z at the start, over the plays from i on
    std::vector<std::size_t> index_;  // first play of each cell of thresholds, for the search
    double cells_per_unit_ = 0.0;
    std::vector<Segment> stack_;
};

}  // namespace hyst
