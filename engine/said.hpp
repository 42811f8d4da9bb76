// What an operator says of a stage, for the kernel in other number types.
#pragma once

#include "dual/derivative.hpp"
#include "kinds/kind.hpp"

namespace hyst {

inline Said said_of(const kinds::Given &given) {
    std::vector<Said> inside;
    for (const kinds::Given &each : given.inside) inside.push_back(said_of(each));
    return {given.kind, given.form, given.constants, given.fixed, given.choices, given.dt, inside};
}

}  // namespace hyst
