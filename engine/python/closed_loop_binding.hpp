// What Python sees of tracking controllers and closed loops.
#pragma once

#include <nanobind/nanobind.h>

namespace hyst {

void bind_closed_loop(nanobind::module_ &module);

}  // namespace hyst
