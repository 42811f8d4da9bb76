// Python's way to add stages with memory of reversals to a chain.
#pragma once

#include <nanobind/nanobind.h>

#include "chain.hpp"

namespace hyst {

void bind_memory_stages(nanobind::class_<Chain> &chain);

}  // namespace hyst
