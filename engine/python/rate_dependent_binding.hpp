// What Python sees of the inversion of rate-dependent plays.
#pragma once

#include <nanobind/nanobind.h>

namespace hyst {

void bind_rate_dependent_inversion(nanobind::module_ &module);

}  // namespace hyst
