#include "memory_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hyst {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::max();
constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();

}  // namespace

bool is_admissible(const hyst_pi &pi, const double *z) {
    for (std::size_t i = 0; i + 1 < pi.count; ++i) {
        const double size = std::abs(z[i]) + std::abs(z[i + 1]) + pi.r[i + 1];
        const double reach = pi.r[i + 1] - pi.r[i] + kRounding * size;
        if (!(std::abs(z[i + 1] - z[i]) <= reach)) return false;
    }
    return true;
}

MemoryCurve::MemoryCurve(const hyst_pi &pi, const double *z)
    : pi_(pi), z_(z), p_sum_(pi.count + 1), pr_sum_(pi.count + 1), start_sum_(pi.count + 1) {
    for (std::size_t i = 0; i < pi.count; ++i) {
        p_sum_[i + 1] = p_sum_[i] + pi.p[i];
        pr_sum_[i + 1] = pr_sum_[i] + pi.p[i] * pi.r[i];
    }
    for (std::size_t i = pi.count; i-- > 0;) start_sum_[i] = start_sum_[i + 1] + pi.p[i] * z[i];
    build_index();
}

// Cells of equal width over the thresholds, twice as many as plays: evenly spread plays are found
// in one look, any others by bisection inside a cell.
void MemoryCurve::build_index() {
    const double largest = pi_.r[pi_.count - 1];
    const std::size_t cells = 2 * pi_.count;
    if (largest > 0.0) cells_per_unit_ = static_cast<double>(cells) / largest;
    if (!std::isfinite(cells_per_unit_)) cells_per_unit_ = 0.0;
    index_.assign(cells + 2, pi_.count);
    std::size_t i = 0;
    for (std::size_t cell = 0; cell <= cells; ++cell) {
        while (i < pi_.count && pi_.r[i] * cells_per_unit_ < static_cast<double>(cell)) ++i;
        index_[cell] = i;
    }
}

// First play of [first, end) that an input `distance` away from the segment does not pass: 2 r >= it.
std::size_t MemoryCurve::first_not_passed(double distance, std::size_t first,
                                          std::size_t end) const {
    const double r = 0.5 * distance;
    if (first >= end || pi_.r[first] >= r) return first;
    if (pi_.r[end - 1] < r) return end;
    const auto cell = static_cast<std::size_t>(r * cells_per_unit_);
    // One cell of slack on either side takes up the rounding of the product.
    const std::size_t from = std::max(first, index_[cell > 0 ? cell - 1 : 0]);
    const std::size_t to = std::min(end, index_[std::min(cell + 2, index_.size() - 1)]);
    if (to <= from) return from;
    return static_cast<std::size_t>(std::lower_bound(pi_.r + from, pi_.r + to, r) - pi_.r);
}

// Sum of p z over the plays from `first` on, the first of them on this segment.
double MemoryCurve::sum_from(const Segment &segment, std::size_t first) const {
    return segment.e * (p_sum_[segment.end] - p_sum_[first]) -
           segment.way * (pr_sum_[segment.end] - pr_sum_[first]) + segment.tail;
}

// The input has passed all segments: which of the plays that still hold their start does it push?
template <MemoryCurve::Way way>
Line MemoryCurve::settle_on_start(double u, std::size_t first) {
    std::size_t i = first;
    while (i < pi_.count && way * z_[i] + pi_.r[i] < way * u) ++i;
    const double limit = i < pi_.count ? z_[i] + way * pi_.r[i] : way * kNoLimit;
    stack_.push_back({u, way, i, start_sum_[i]});
    return {0.0, 0.0, limit};
}

// The input moves to u, up for kRising. Segments it passes are wiped out.
template <MemoryCurve::Way way>
Line MemoryCurve::turn(double u) {
    std::size_t first = 0;  // plays before it are pushed by u
    if (!stack_.empty() && stack_.back().way == way) {
        first = stack_.back().end;
        stack_.pop_back();
    }
    for (; !stack_.empty(); stack_.pop_back()) {
        const Segment &reached = stack_.back();
        if (reached.way == way) {
            // Left by an input that moved the same way: wiped out where u goes further than it did.
            if (way * reached.e >= way * u) {
                const double limit = reached.e, tail = sum_from(reached, first);
                stack_.push_back({u, way, first, tail});
                return {0.0, 0.0, limit};
            }
        } else {
            first = first_not_passed(way * (u - reached.e), first, reached.end);
            if (first < reached.end) {
                const double limit = reached.e + way * 2.0 * pi_.r[first];
                const double tail = sum_from(reached, first);
                stack_.push_back({u, way, first, tail});
                return {0.0, 0.0, limit};
            }
        }
        first = reached.end;
    }
    return settle_on_start<way>(u, first);
}

Line MemoryCurve::move_to(double u) {
    const bool rises = stack_.empty() ? u > z_[0] - pi_.r[0] : u > stack_.back().e;
    Line line = rises ? turn<kRising>(u) : turn<kFalling>(u);
    const Segment &top = stack_.back();
    line.a = top.tail - top.way * pr_sum_[top.end];
    line.b = pi_.p0 + p_sum_[top.end];
    return line;
}

std::size_t MemoryCurve::run(const double *u, double *y, std::size_t count) {
    const Kernels &fast = kernels();
    std::size_t k = 0;
    while (k < count && std::isfinite(u[k])) {
        const Line line = move_to(u[k]);
        y[k] = line.a + line.b * u[k];
        ++k;
        const auto follow = stack_.back().way == kRising ? fast.rise : fast.fall;
        k += follow(line, u + k, y + k, count - k);
        stack_.back().e = u[k - 1];
    }
    return k;
}

}  // namespace hyst
