// What Python sees of repetitive controllers.
#pragma once

#include <nanobind/nanobind.h>

namespace hyst {

void bind_repetitive(nanobind::module_ &module);

}  // namespace hyst
