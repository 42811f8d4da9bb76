// What Python sees of batches.
#pragma once

#include <nanobind/nanobind.h>

namespace hyst {

void bind_batches(nanobind::module_ &module);

}  // namespace hyst
