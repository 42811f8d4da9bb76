// The memory curve engine: prepares what simd/memory_curve_kernel.hpp, where the algorithm is, runs on.
//
// Sums over the plays of a segment are differences of prefix sums of p and p r; y therefore agrees
// with the core's sum in order to rounding, not to the bit. The memory itself is not read from here
// but from the jump (lanes.hpp), which is exact.
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
    MemoryCurve(const MemoryCurve &) = delete;
    MemoryCurve &operator=(const MemoryCurve &) = delete;

    // The next samples; y may not be u. Returns how many were finite and have been taken, 0 if y was
    // not finite.
    std::size_t run(const double *u, double *y, std::size_t count) {
        return kernels().memory_curve(data_, u, y, count);
    }

    const MemoryCurveData &data() const { return data_; }

private:
    void build_index(const hyst_pi &pi);

    std::vector<double> p_sum_, pr_sum_, start_sum_;
    std::vector<std::size_t> first_in_cell_;
    std::vector<Segment> stack_;
    MemoryCurveData data_;
};

}  // namespace hyst
