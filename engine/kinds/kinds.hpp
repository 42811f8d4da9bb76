// The rows of engine/kinds/kinds.cpp that engines know by name.
#pragma once

#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {

extern const Kind pi, rate_dependent_pi;

}  // namespace HYST_KINDS
}  // namespace hyst
