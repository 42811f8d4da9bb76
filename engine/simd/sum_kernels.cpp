// Compiled once per instruction set, with contraction allowed.
#include "sum_kernels.hpp"

#include "gradient_kernel.hpp"
#include "gram_kernel.hpp"

namespace hyst::HYST_INSTRUCTION_SET {

GradientSums sum_gradient(const GradientBank &bank, const double *u, const double *target,
                          std::size_t samples, std::size_t stride) {
    return gradient_lanes(bank, u, target, samples, stride);
}

void sum_gram(const double *rows, std::size_t samples, std::size_t width, std::size_t stride,
              double *gram) {
    add_gram(rows, samples, width, stride, gram);
}

}  // namespace hyst::HYST_INSTRUCTION_SET
