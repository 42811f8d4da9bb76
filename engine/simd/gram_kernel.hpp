// Sum of outer products of rows: the lower triangle of rows' rows, and a little beyond its diagonal.
#pragma once

#include "pack.hpp"

namespace hyst::HYST_INSTRUCTION_SET {

// Four rows of the matrix at a time; each pack of a row is loaded once for the four.
inline void add_gram(const double *rows, std::size_t samples, std::size_t width, std::size_t stride,
                     double *gram) {
    for (std::size_t i = 0; i < width; i += 4) {
        for (std::size_t j = 0; j < i + 4 && j < stride; j += kWidth) {
            Pack sum[4];
#pragma GCC unroll 4
            for (std::size_t a = 0; a < 4; ++a) sum[a] = load(gram + (i + a) * stride + j);
            for (std::size_t k = 0; k < samples; ++k) {
                const double *row = rows + k * stride;
                const Pack right = load(row + j);
#pragma GCC unroll 4
                for (std::size_t a = 0; a < 4; ++a) sum[a] += row[i + a] * right;
            }
#pragma GCC unroll 4
            for (std::size_t a = 0; a < 4; ++a) store(gram + (i + a) * stride + j, sum[a]);
        }
    }
}

}  // namespace hyst::HYST_INSTRUCTION_SET
