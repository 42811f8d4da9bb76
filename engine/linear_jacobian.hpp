// Forward-mode derivative of the linear stages of a chain.
#pragma once

#include <cstddef>

#include "hyst/hyst.h"

namespace hyst {

// A record on its way through a chain. On entry `signal` is the input of the stage and columns
// [0, incoming) of each row its derivatives; on exit the same of the output, and the columns from
// `incoming` on hold the derivatives by the constants of the stage.
struct LinearTangents {
    double *signal;
    std::size_t samples;
    double *rows;
    std::size_t stride;
    std::size_t incoming;
};

// Own columns: A row after row, B, C, D. The initial state does not depend on any of them.
void state_space_jacobian(const hyst_state_space &system, const double *state,
                          const LinearTangents &tangents);

// Own columns: b0 b1 b2 a1 a2 of each section.
void sections_jacobian(const hyst_sections &sections, const double *state,
                       const LinearTangents &tangents);

}  // namespace hyst
