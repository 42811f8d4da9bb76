// The drive that gives rate-dependent plays a wanted output, sample by sample.
#pragma once

#include <cstddef>

#include "hyst/rate_dependent_prandtl_ishlinskii.h"

namespace hyst {

struct SampleExact {
    std::size_t solved;   // samples solved; the first one not solved ends the record
    std::size_t several;  // samples whose equation had more than one solution
};

// Solves  y(u_k) = target_k  given the state that u_0 .. u_{k-1} left; of several solutions the one
// nearest to u_{k-1}. u is held within [low, high]. The state is carried in and out.
SampleExact sample_exact(const hyst_rate_dependent_pi &model, double *state, const double *target,
                         double *u, std::size_t samples, double low, double high);

}  // namespace hyst
