// What Python sees of limited drives.
#pragma once

#include <nanobind/nanobind.h>

namespace hyst {

void bind_limited_drive(nanobind::module_ &module);

}  // namespace hyst
