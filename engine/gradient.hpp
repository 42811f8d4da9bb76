// Loss of a model on a record, and its gradient, without a stored Jacobian.
#pragma once

#include <cstddef>

#include "chain.hpp"
#include "evaluation.hpp"

namespace hyst {

// Loss 1/2 sum_k (y_k - target_k)^2 of a chain, and its derivatives by the constants in the order of
// jacobian.hpp. state: in and out. options: as for evaluation.
double loss_gradient(const Chain &chain, double *state, const double *u, const double *target,
                     std::size_t samples, const Options &options, double *gradient);

// The same of a single bank of plays, whose thresholds must ascend from zero or more: by p0,
// p_1 .. p_n, r_1 .. r_n.
double pi_loss_gradient(const hyst_pi &pi, double *z, const double *u, const double *target,
                        std::size_t samples, const Options &options, double *gradient);

}  // namespace hyst
