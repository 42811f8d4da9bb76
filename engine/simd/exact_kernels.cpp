// Compiled once per instruction set, without contraction; the table of all its kernels.
#include "columns_kernel.hpp"
#include "curve_gradient_kernel.hpp"
#include "jump_kernel.hpp"
#include "kernels.hpp"
#include "lanes_kernel.hpp"
#include "memory_curve_kernel.hpp"
#include "memoryless_kernel.hpp"
#include "power_law_inverse_kernel.hpp"
#include "power_law_kernel.hpp"
#include "rows_kernel.hpp"
#include "sum_kernels.hpp"

namespace hyst::HYST_INSTRUCTION_SET {
namespace {

bool pi_lanes(const hyst_pi &pi, const double *u, double *y, std::size_t samples,
              std::size_t stride, double *z) {
    PlayBank<ConstantThreshold> bank{pi, {}, z};
    return lanes(bank, u, y, samples, stride);
}

bool rate_dependent_pi_lanes(const hyst_rate_dependent_pi &model, const double *previous,
                             const double *u, double *y, std::size_t samples, std::size_t stride,
                             double *z) {
    PlayBank<RateDependentThreshold> bank{
        model.pi, {model, load(previous)}, z};
    return lanes(bank, u, y, samples, stride);
}

bool play_lanes(double r, bool stop, const double *u, double *y, std::size_t samples,
                std::size_t stride, double *z) {
    SinglePlay play{broadcast(r), stop, load(z)};
    const bool finite = lanes(play, u, y, samples, stride);
    store(z, play.z);
    return finite;
}

void pi_jump(const double *u, std::size_t count, std::size_t plays, const double *r, double *z,
             double *direction) {
    jump(PlainSamples{u}, count, plays, r, z, direction);
}

void rate_dependent_pi_jump(const hyst_rate_dependent_pi &model, double previous, const double *u,
                            std::size_t count, double *z) {
    jump(RateDependentSamples{model, u, previous}, count, model.pi.count, model.pi.r, z, nullptr);
}

#define HYST_TEXT_OF(name) #name
#define HYST_TEXT(name) HYST_TEXT_OF(name)

}  // namespace

extern const Kernels kKernelTable;
const Kernels kKernelTable = {HYST_TEXT(HYST_INSTRUCTION_SET),
                              kWidth,
                              pi_lanes,
                              rate_dependent_pi_lanes,
                              play_lanes,
                              pi_jump,
                              rate_dependent_pi_jump,
                              memory_curve,
                              first_non_finite,
                              affine,
                              dead_zone,
                              power_law_branch,
                              inverse_power_law_branch,
                              curve_gradient,
                              finish_curve_gradient,
                              sum_gradient,
                              derivative_rows,
                              play_rows,
                              sum_gram,
                              add_columns};

}  // namespace hyst::HYST_INSTRUCTION_SET
