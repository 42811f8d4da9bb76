// The inner loops that exist once per instruction set, and the choice among them at run time.
#pragma once

#include <cstddef>

#include "hyst/dead_zone.h"
#include "hyst/loading_curve.h"
#include "hyst/prandtl_ishlinskii.h"
#include "hyst/rate_dependent_prandtl_ishlinskii.h"

namespace hyst {

// Which way a play moved last: the derivative of its memory by its own threshold.
constexpr double kRose = -1.0;
constexpr double kFell = 1.0;

constexpr std::size_t kJumpBlock = 64;  // samples the backward scan takes at once
constexpr std::size_t kGramBlock = 64;  // rows the Gram matrix takes at once
constexpr std::size_t kWidest = 8;      // lanes of the widest instruction set

// y = a + b u from sample to sample while u moves one way, no further than `limit`.
struct Line {
    double a;
    double b;
    double limit;
};

// Neighbouring plays of the memory curve that one movement of the input has left.
struct Segment {
    double e;         // the input where the movement ended
    int way;          // 1: it rose, z = e - r; -1: it fell, z = e + r
    std::size_t end;  // first play beyond the segment
    double tail;      // sum of p z over the plays beyond it
    double errors_before;  // for gradients: sum of all errors until the movement ended
};

struct MemoryCurveData {
    const hyst_pi *pi;
    const double *start;               // memories at the start
    const double *p_sum;               // of the first i weights
    const double *pr_sum;              // of the first i products p r
    const double *start_sum;           // of p z at the start, over the plays from i on
    const std::size_t *first_in_cell;  // for the search among thresholds: first play of each cell
    double cells_per_unit;
    Segment *stack;  // count + 2: at most one segment a play, and an empty one on top
    std::size_t depth;
    double largest;  // magnitude of the samples taken so far
};

// Sums of the gradient along a memory curve; see curve_gradient_kernel.hpp.
struct CurveGradientData {
    MemoryCurveData curve;
    double *by_input, *by_way;  // differences over the plays, count + 1
    double *from_start;         // sum of the errors while play i held its start
    double errors, by_p0, loss;
};

// The loss gradient's view of a bank: everything is in packs, one for each play.
struct GradientBank {
    hyst_pi pi;
    double *z;             // memories of the lanes
    double *direction;     // their last movements
    double *by_p;          // out: sums of error times memory
    double *by_direction;  // out: sums of error times direction
    double *scratch;       // 2 x width x count packs
};

struct GradientSums {
    double loss;     // half the sum of squared errors
    double by_p0;    // sum of error times input
    double largest;  // magnitude of the input
};

// A branch of a loading curve: y = output +- twice f(|share u - start|).
struct Branch {
    double share, start, output, twice;
};

// What is added to: what is in the sums, 0, or nothing, so that a first product keeps its sign of zero.
enum class Begin { from_sums, from_zero, from_first };

struct Kernels {
    const char *name;
    std::size_t width;  // lanes

    // `width` records side by side; lane c at u + c * stride. z: one pack for each play.
    // samples: a multiple of width. u and y may be the same. Returns whether both were finite.
    bool (*pi_lanes)(const hyst_pi &pi, const double *u, double *y, std::size_t samples,
                     std::size_t stride, double *z);
    bool (*rate_dependent_pi_lanes)(const hyst_rate_dependent_pi &model, const double *previous,
                                    const double *u, double *y, std::size_t samples,
                                    std::size_t stride, double *z);
    bool (*play_lanes)(double r, bool stop, const double *u, double *y, std::size_t samples,
                       std::size_t stride, double *z);

    // Memories of all plays after `count` samples. r ascends, r[0] >= 0.
    void (*pi_jump)(const double *u, std::size_t count, std::size_t plays, const double *r,
                    double *z, double *direction);
    void (*rate_dependent_pi_jump)(const hyst_rate_dependent_pi &model, double previous,
                                   const double *u, std::size_t count, double *z);

    // Returns how many samples were finite and have been taken. y may not be u.
    std::size_t (*memory_curve)(MemoryCurveData &curve, const double *u, double *y,
                                std::size_t count);

    std::size_t (*first_non_finite)(const double *u, std::size_t count);  // count if there is none
    void (*affine)(double gain, double offset, const double *u, double *y, std::size_t count);
    void (*dead_zone)(const hyst_dead_zone &map, const double *u, double *y, std::size_t count);
    // Points of one branch of a power law. u and y may be the same.
    void (*power_law_branch)(const hyst_power_law &f, const Branch &branch, const double *u,
                             double *y, std::size_t count);
    // The same of its inverse: u holds outputs of the law, y takes inputs.
    void (*inverse_power_law_branch)(const hyst_power_law &f, const Branch &branch, const double *u,
                                     double *y, std::size_t count);

    // u is finite. y: scratch of `count`. Call the second when the record is over.
    void (*curve_gradient)(CurveGradientData &data, const double *u, const double *target,
                           double *y, std::size_t count);
    void (*finish_curve_gradient)(CurveGradientData &data);
    GradientSums (*gradient_lanes)(const GradientBank &bank, const double *u, const double *target,
                                   std::size_t samples, std::size_t stride);
    // Every play's memory and direction after each sample, one row of `stride` doubles a sample.
    void (*derivative_rows)(const hyst_pi &pi, double *z, double *direction, const double *u,
                            std::size_t samples, double *by_p, double *by_r, std::size_t stride);
    // Play outputs of a block, `stride` a multiple of width; z and r padded to it.
    void (*play_rows)(const double *r, double *z, std::size_t stride, const double *u,
                      std::size_t samples, double *rows);
    // gram += rows' rows, lower triangle and a little more. stride: a multiple of width.
    void (*add_gram)(const double *rows, std::size_t samples, std::size_t width, std::size_t stride,
                     double *gram);
    // sums = a matrix of `count` columns, one after the other, times z. rows: a multiple of four.
    void (*add_columns)(const double *columns, std::size_t rows, const double *z,
                        std::size_t count, Begin begin, double *sums);
};

// The kernels in use: the widest this processor runs, unless another set was asked for.
const Kernels &kernels();

inline bool all_finite(const double *u, std::size_t count) {
    return kernels().first_non_finite(u, count) == count;
}

// All sets this build has and this processor runs, widest first; ends with a null pointer.
const Kernels *const *available_kernels();

// Use the set of this name from now on. Returns false, and changes nothing, if it is not available.
bool use_kernels(const char *name);

}  // namespace hyst
