// Columns of numbers as text, for Python.
#pragma once

#include <nanobind/nanobind.h>

namespace hyst {

void bind_number_text(nanobind::module_ &module);

}  // namespace hyst
