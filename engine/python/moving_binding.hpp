// Chains whose constants follow a second signal, for Python.
#pragma once

#include <nanobind/nanobind.h>

namespace hyst {

void bind_moving(nanobind::module_ &module);

}  // namespace hyst
