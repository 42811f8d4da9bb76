// A small matrix times a vector, column after column: the sums of all rows run side by side.
#pragma once

#include "kernels.hpp"
#include "pack.hpp"

namespace hyst::HYST_INSTRUCTION_SET {

// Four rows, whatever the width: the matrices of a control loop have few.
using Four = double __attribute__((vector_size(4 * sizeof(double))));

inline Four four(const double *from) {
    Four numbers;
    __builtin_memcpy(&numbers, from, sizeof numbers);
    return numbers;
}

// For so many fours the compiler keeps the sums in registers, if it sees each by itself: copied as one
// piece they pass through memory, in pieces for which a processor waits.
template <std::size_t fours>
inline void add_known(const double *columns, const double *z, std::size_t count, Begin begin,
                      double *sums) {
    Four held[fours];
#pragma GCC unroll 5
    for (std::size_t i = 0; i < fours; ++i) {
        held[i] = begin == Begin::from_sums   ? four(sums + 4 * i)
                  : begin == Begin::from_zero ? Four{}
                                              : four(columns + 4 * i) * z[0];
    }
    for (std::size_t j = begin == Begin::from_first ? 1 : 0; j < count; ++j) {
        const double *column = columns + j * 4 * fours;
#pragma GCC unroll 5
        for (std::size_t i = 0; i < fours; ++i) held[i] += four(column + 4 * i) * z[j];
    }
#pragma GCC unroll 5
    for (std::size_t i = 0; i < fours; ++i) {
        __builtin_memcpy(sums + 4 * i, &held[i], sizeof(Four));
    }
}

// sums = columns times z, added up as `begin` says; rows: a multiple of four.
inline void add_columns(const double *columns, std::size_t rows, const double *z,
                        std::size_t count, Begin begin, double *sums) {
    switch (rows) {
        case 4: return add_known<1>(columns, z, count, begin, sums);
        case 8: return add_known<2>(columns, z, count, begin, sums);
        case 12: return add_known<3>(columns, z, count, begin, sums);
        case 16: return add_known<4>(columns, z, count, begin, sums);
        case 20: return add_known<5>(columns, z, count, begin, sums);
        default: break;
    }
    std::size_t j = begin == Begin::from_first ? 1 : 0;
    for (std::size_t i = 0; i < rows && begin != Begin::from_sums; ++i) {
        sums[i] = j == 1 ? columns[i] * z[0] : 0.0;
    }
    for (; j < count; ++j) {
        for (std::size_t i = 0; i < rows; ++i) sums[i] += columns[j * rows + i] * z[j];
    }
}

}  // namespace hyst::HYST_INSTRUCTION_SET
