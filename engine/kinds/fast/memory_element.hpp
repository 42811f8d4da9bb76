// Memory elements in double: own derivative.
#pragma once

#include "../tangents.hpp"

namespace hyst {

// Own columns: c1 c2 c3; a_0 .. a_n; or the values of the table.
void memory_element_jacobian(const void *model, double dt, const double *state,
                             const Tangents &tangents);

}  // namespace hyst
