// The memory curve engine: prepares what simd/memory_curve_kernel.hpp, where the algorithm is, runs on.
//
// Sums over the plays of a segment are differences of prefix sums of p and p r; y therefore agrees
// with the core's sum in order to rounding, not to the bit. The memory itself is not read from here
// but from the jump (lanes.hpp), which is exact.
//
// Sums in another order overflow elsewhere, and a sample is refused for an overflow of the core's.
// So y counts only where |u| stays within the headroom, in which no order overflows.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "hyst/prandtl_ishlinskii.h"
#include "../simd/kernels.hpp"

namespace hyst {

// Whether z is a memory an input can have left: |z_{i+1} - z_i| <= r_{i+1} - r_i, to rounding.
bool is_admissible(const hyst_pi &pi, const double *z);

constexpr double kHuge = std::numeric_limits<double>::max() / 8.0;

// As long as |u| stays within this, p0 u and all p z in whatever order, with prefix sums or without,
// add up to no more than a small multiple of `limit`, kHuge at most. NaN or negative if none will do.
double headroom(const hyst_pi &pi, const double *z, double limit);

class MemoryCurve {
public:
    // pi, with its thresholds ascending from >= 0 and at least one play, and z, admissible, must
    // outlive this.
    MemoryCurve(const hyst_pi &pi, const double *z);
    MemoryCurve(const MemoryCurve &) = delete;
    MemoryCurve &operator=(const MemoryCurve &) = delete;

    // The next samples; y may not be u. Returns whether they were finite; if not, y is meaningless.
    bool run(const double *u, double *y, std::size_t count) {
        return kernels().memory_curve(data_, u, y, count) == count;
    }
    // Magnitude of the samples so far.
    double largest() const { return data_.largest; }

    const MemoryCurveData &data() const { return data_; }

private:
    void build_index(const hyst_pi &pi);

    std::vector<double> p_sum_, pr_sum_, start_sum_;
    std::vector<std::size_t> first_in_cell_;
    std::vector<Segment> stack_;
    MemoryCurveData data_;
};

}  // namespace hyst
