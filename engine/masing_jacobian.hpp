// Forward-mode derivative of a loading curve with memory of reversals.
#pragma once

#include <cstddef>

#include "linear_jacobian.hpp"

namespace hyst {

// Own columns: c1 c2 c3 of a power law; p0, p, r of plays; a_1 .. a_n of a polynomial.
std::size_t parameter_count(const hyst_masing &model);
void masing_jacobian(const hyst_masing &model, const double *state, const LinearTangents &tangents);

}  // namespace hyst
