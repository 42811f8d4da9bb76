#pragma once

#include <cstddef>

namespace hyst {

// A record on its way back through a stage. `signal` holds the derivatives of a number by the output of
// each sample on entry, by its input on exit; `by_constants`, one entry for each parameter of the stage,
// receives those by the parameters.
struct Cotangents {
    const double *u;  // the stage's input
    double *signal;
    std::size_t samples;
    double *by_constants;
    // The record is gone back through in blocks of so many samples; the states before each, one after
    // the other.
    std::size_t block;
    const double *states;

    std::size_t blocks() const { return (samples + block - 1) / block; }
    std::size_t end(std::size_t b) const { return (b + 1) * block < samples ? (b + 1) * block : samples; }
};

}  // namespace hyst
