// A stage as its operator says it, in the number type of this translation unit.
#pragma once

#include "derivative.hpp"

namespace hyst {
namespace HYST_KINDS {

// Stages inside have constants among those of the stage around them; their own tell how many.
static inline Given given_of(const Said &said)
{
    Given given{said.kind, said.form, {}, said.fixed, said.choices, said.dt};
    for (double constant : said.constants) given.constants.emplace_back(constant);
    for (const Said &each : said.inside) given.inside.push_back(given_of(each));
    return given;
}

}  // namespace HYST_KINDS
}  // namespace hyst
