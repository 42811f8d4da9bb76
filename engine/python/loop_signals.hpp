// What enters a simulated loop and what comes out, as Python gives it.
#pragma once

#include <nanobind/ndarray.h>

#include <cstddef>
#include <stdexcept>

#include "../tasks/closed_loop.hpp"

namespace hyst {

using LoopRecord = nanobind::ndarray<const double, nanobind::ndim<1>, nanobind::c_contig,
                                     nanobind::device::cpu>;
using LoopOutputs =
    nanobind::ndarray<double, nanobind::ndim<2>, nanobind::c_contig, nanobind::device::cpu>;

// r, noise, disturbance before and behind the hysteresis: N samples, or one for all.
struct LoopRecords {
    LoopRecord r, noise, before, behind;

    // out: v, u, eta, y, d_hat.
    LoopSignals with(const LoopOutputs &out) const {
        const std::size_t n = out.shape(1);
        if (out.shape(0) != 5) throw std::invalid_argument("the signals have the wrong shape");
        double *o = out.data();
        return {input(r, n), input(noise, n), input(before, n), input(behind, n), o,
                o + n,       o + 2 * n,       o + 3 * n,        o + 4 * n,        n};
    }

private:
    static LoopInput input(const LoopRecord &given, std::size_t samples) {
        if (given.shape(0) != samples && given.shape(0) != 1) {
            throw std::invalid_argument("the signals have the wrong shape");
        }
        return {given.data(), given.shape(0) == 1 ? 0u : 1u};
    }
};

}  // namespace hyst
