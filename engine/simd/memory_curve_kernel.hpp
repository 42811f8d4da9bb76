// The memory of all plays at once, as the curve r -> z(r): cost per sample independent of how many
// plays there are.
//
// Invariant: plays ascend by r. From the smallest on, the stack's top segment first, plays
// [end of the segment above, end of the segment) hold z = e - r where a rising input last left them,
// or z = e + r where a falling one did; plays from the lowest segment's end on hold what they held
// at the start. A rising input pushes the smallest plays, up to the first whose z + r it does not
// reach. So the output is a + b u until the next play, or the next segment, is reached.
#pragma once

#include "kernels.hpp"
#include "line_kernel.hpp"

namespace hyst::HYST_INSTRUCTION_SET {

constexpr double kNoLimit = __DBL_MAX__;  // finite, so that infinities stop at it

// First play of [first, end) that an input `distance` away from the segment does not pass: 2 r >= it.
inline std::size_t first_not_passed(const MemoryCurveData &curve, double distance,
                                    std::size_t first, std::size_t end) {
    const double *thresholds = curve.pi->r;
    const double r = 0.5 * distance;
    // A smooth input has passed one play more than before, or none.
    for (std::size_t i = first; i < first + 2; ++i) {
        if (i >= end || thresholds[i] >= r) return i;
    }
    if (thresholds[end - 1] < r) return end;
    // The product that numbered the cells numbers r too, so plays of cells before have less than r.
    const auto cell = static_cast<std::size_t>(r * curve.cells_per_unit);
    constexpr std::size_t few = 4;
    std::size_t i = curve.first_in_cell[cell] > first ? curve.first_in_cell[cell] : first;
    for (const std::size_t stop = i + few; i < stop; ++i) {
        if (i >= end || thresholds[i] >= r) return i;
    }
    // Here thresholds[i - 1] < r <= thresholds[end - 1].
    for (std::size_t beyond = end; i < beyond;) {
        const std::size_t middle = i + (beyond - i) / 2;
        if (thresholds[middle] < r) {
            i = middle + 1;
        } else {
            beyond = middle;
        }
    }
    return i;
}

// Sum of p z over the plays from `first` on, the first of them on this segment.
inline double sum_from(const MemoryCurveData &curve, const Segment &segment, std::size_t first) {
    return segment.e * (curve.p_sum[segment.end] - curve.p_sum[first]) -
           segment.way * (curve.pr_sum[segment.end] - curve.pr_sum[first]) + segment.tail;
}

inline double push(MemoryCurveData &curve, const Segment &segment, double limit) {
    curve.stack[curve.depth++] = segment;
    return limit;
}

// Told which plays the input starts to push, and at each reversal; evaluation has no use for it.
struct NoObserver {
    void reversed(Segment &) {}
    void pushes(const Segment &, std::size_t, std::size_t) {}
    void pushes_from_start(std::size_t) {}
};

// The input has passed all segments: which of the plays that still hold their start does it push?
template <int way, class Observer>
inline double settle_on_start(MemoryCurveData &curve, double u, std::size_t first,
                              Observer &observer) {
    const hyst_pi &pi = *curve.pi;
    std::size_t i = first;
    for (; i < pi.count && way * curve.start[i] + pi.r[i] < way * u; ++i) {
        observer.pushes_from_start(i);
    }
    return push(curve, {u, way, i, curve.start_sum[i], 0.0},
                i < pi.count ? curve.start[i] + way * pi.r[i] : way * kNoLimit);
}

// The input moves to u, up for way = 1, down for -1. Segments it passes are wiped out. Returns how
// far the input may go on before it reaches the next play or segment.
template <int way, class Observer>
inline double turn(MemoryCurveData &curve, double u, Observer &observer) {
    std::size_t first = 0;  // plays before it are pushed by u
    if (curve.depth > 0 && curve.stack[curve.depth - 1].way == way) {
        first = curve.stack[--curve.depth].end;
    } else if (curve.depth > 0) {
        observer.reversed(curve.stack[curve.depth - 1]);
    }
    for (; curve.depth > 0; --curve.depth) {
        const Segment reached = curve.stack[curve.depth - 1];
        if (reached.way == way) {
            // Left by an input that moved the same way: wiped out where u goes further than it did.
            if (way * reached.e >= way * u) {
                return push(curve, {u, way, first, sum_from(curve, reached, first), 0.0}, reached.e);
            }
            observer.pushes(reached, first, reached.end);
        } else {
            const std::size_t before = first;
            first = first_not_passed(curve, way * (u - reached.e), first, reached.end);
            observer.pushes(reached, before, first);
            if (first < reached.end) {
                return push(curve, {u, way, first, sum_from(curve, reached, first), 0.0},
                            reached.e + way * 2.0 * curve.pi->r[first]);
            }
        }
        first = reached.end;
    }
    return settle_on_start<way>(curve, u, first, observer);
}

// One sample by turn, and those after it that stay on its line. Returns how many.
template <int way, class Observer>
inline std::size_t sweep(MemoryCurveData &curve, const double *u, double *y, std::size_t count,
                         Observer &observer) {
    const double limit = turn<way>(curve, u[0], observer);
    Segment &top = curve.stack[curve.depth - 1];
    const Line line{top.tail - way * curve.pr_sum[top.end], curve.pi->p0 + curve.p_sum[top.end],
                    limit};
    y[0] = line.a + line.b * u[0];
    const std::size_t taken = 1 + follow<(way > 0)>(line, u + 1, y + 1, count - 1);
    top.e = u[taken - 1];
    return taken;
}

inline double larger_magnitude(double bound, double u) {
    const double size = u < 0.0 ? -u : u;
    return bound > size ? bound : size;
}

// The next movement of the input, up or down, until it pushes another play. Of a movement the ends
// are the largest.
template <class Observer>
inline std::size_t move(MemoryCurveData &curve, const double *u, double *y, std::size_t count,
                        Observer &observer) {
    const double now = curve.depth > 0 ? curve.stack[curve.depth - 1].e
                                       : curve.start[0] - curve.pi->r[0];
    const std::size_t taken = u[0] > now ? sweep<1>(curve, u, y, count, observer)
                                         : sweep<-1>(curve, u, y, count, observer);
    curve.largest = larger_magnitude(larger_magnitude(curve.largest, u[0]), u[taken - 1]);
    return taken;
}

inline std::size_t memory_curve(MemoryCurveData &curve, const double *u, double *y,
                                std::size_t count) {
    NoObserver observer;
    std::size_t k = 0;
    while (k < count && u[k] - u[k] == 0.0) k += move(curve, u + k, y + k, count - k, observer);
    return k;
}

}  // namespace hyst::HYST_INSTRUCTION_SET
