// Kernels whose sums over samples need not have the core's bits; compiled with contraction allowed.
#pragma once

#include "kernels.hpp"

namespace hyst::HYST_INSTRUCTION_SET {

GradientSums sum_gradient(const GradientBank &bank, const double *u, const double *target,
                          std::size_t samples, std::size_t stride);
void sum_gram(const double *rows, std::size_t samples, std::size_t width, std::size_t stride,
              double *gram);

}  // namespace hyst::HYST_INSTRUCTION_SET
