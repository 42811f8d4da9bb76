// Loss of a model on a record, and its gradient, without a stored Jacobian.
#pragma once

#include <cstddef>

#include "../chain.hpp"
#include "evaluation.hpp"

namespace hyst {

// Loss 1/2 sum_k (y_k - target_k)^2 of a chain, and its derivatives by the constants in the order of
// jacobian.hpp. state: in and out. options: as for evaluation. NaN, and the state as it was, where
// evaluation would refuse a sample.
double loss_gradient(const Chain &chain, double *state, const double *u, const double *target,
                     std::size_t samples, const Options &options, double *gradient);

}  // namespace hyst
