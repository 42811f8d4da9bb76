#pragma once

#include <nanobind/nanobind.h>

#include "../chain.hpp"

namespace hyst {

// What a hyst.operators.stage.Stage says.
kinds::Given as_given(nanobind::handle stage);

// How a chain is made of stages, what it tells of them, and the names of all kinds.
void bind_stages(nanobind::module_ &module, nanobind::class_<Chain> &chain);

}  // namespace hyst
