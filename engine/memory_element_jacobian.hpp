// Forward-mode derivative of a memory element.
#pragma once

#include "linear_jacobian.hpp"

namespace hyst {

// Own columns: c1 c2 c3; a_0 .. a_n; or the values of the table.
void memory_element_jacobian(const hyst_memory_element &model, const double *state,
                             const LinearTangents &tangents);

}  // namespace hyst
