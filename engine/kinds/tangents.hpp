#pragma once

#include <cstddef>

namespace hyst {

// A record on its way through a chain, with its derivatives. On entry `signal` is the input of the
// stage and columns [0, incoming) of each row its derivatives; on exit the same of the output, and the
// columns from `incoming` on hold the derivatives by the parameters of the stage.
struct Tangents {
    double *signal;
    std::size_t samples;
    double *rows;
    std::size_t stride;
    std::size_t incoming;

    double *row(std::size_t k) const { return rows + k * stride; }
    double *own(std::size_t k) const { return row(k) + incoming; }
    void scale(std::size_t k, double factor) const {
        for (std::size_t c = 0; c < incoming; ++c) row(k)[c] *= factor;
    }
};

}  // namespace hyst
