// Loss and gradient along the memory curve: like y, at a cost independent of how many plays there are.
//
// Invariant: while a play is held, its memory and its direction are constant, so all it adds to the
// gradient is their product with the sum of the errors meanwhile; that is added when the play is
// pushed again. While it is pushed, z = u - way r: it adds the sum of error times u, and of the
// errors. Both concern neighbouring plays, so they go into differences over the plays, summed up at
// the very end:
//   sum_k error_k z_i(k) = by_input_i + r_i by_way_i,   sum_k error_k direction_i(k) = by_way_i.
#pragma once

#include "kernels.hpp"
#include "memory_curve_kernel.hpp"
#include "pack.hpp"

namespace hyst::HYST_INSTRUCTION_SET {

struct GradientObserver {
    CurveGradientData &data;

    void add(std::size_t first, std::size_t end, double input, double way) {
        data.by_input[first] += input;
        data.by_input[end] -= input;
        data.by_way[first] += way;
        data.by_way[end] -= way;
    }
    void reversed(Segment &top) { top.errors_before = data.errors; }
    void pushes(const Segment &held, std::size_t first, std::size_t end) {
        const double errors = data.errors - held.errors_before;
        add(first, end, held.e * errors, -held.way * errors);
    }
    void pushes_from_start(std::size_t i) {
        data.from_start[i] = data.errors;  // times its start memory and direction
    }
};

inline double lane_sum(Pack pack) {
    double sum = 0.0;
    for (std::size_t lane = 0; lane < kWidth; ++lane) sum += pack[lane];
    return sum;
}

// Errors of a stretch on which plays [0, end of the top segment) are pushed.
inline void add_stretch(GradientObserver &observer, const Segment &top, const double *u,
                        const double *y, const double *target, std::size_t count) {
    Pack errors{}, moments{}, squares{};
    std::size_t k = 0;
    for (; k + kWidth <= count; k += kWidth) {
        const Pack in = load(u + k), error = load(y + k) - load(target + k);
        errors += error;
        moments += error * in;
        squares += error * error;
    }
    double sum = lane_sum(errors), moment = lane_sum(moments), square = lane_sum(squares);
    for (; k < count; ++k) {
        const double error = y[k] - target[k];
        sum += error;
        moment += error * u[k];
        square += error * error;
    }
    observer.data.errors += sum;
    observer.data.by_p0 += moment;
    observer.data.loss += 0.5 * square;
    observer.add(0, top.end, moment, -top.way * sum);
}

// y: scratch of `count`.
inline void curve_gradient(CurveGradientData &data, const double *u, const double *target,
                           double *y, std::size_t count) {
    GradientObserver observer{data};
    for (std::size_t k = 0; k < count;) {
        const std::size_t taken = move(data.curve, u + k, y + k, count - k, observer);
        const Segment &top = data.curve.stack[data.curve.depth - 1];
        add_stretch(observer, top, u + k, y + k, target + k, taken);
        k += taken;
    }
}

// What the plays that are held now have added since they were left.
inline void finish_curve_gradient(CurveGradientData &data) {
    GradientObserver observer{data};
    MemoryCurveData &curve = data.curve;
    std::size_t first = curve.depth > 0 ? curve.stack[curve.depth - 1].end : 0;
    for (std::size_t i = curve.depth; i-- > 1;) {
        const Segment &held = curve.stack[i - 1];
        observer.pushes(held, first, held.end);
        first = held.end;
    }
    for (; first < curve.pi->count; ++first) observer.pushes_from_start(first);
}

}  // namespace hyst::HYST_INSTRUCTION_SET
