// Sum of outer products of rows: the lower triangle of rows' rows, and a little beyond its diagonal.
#pragma once

#include "pack.hpp"

namespace hyst::HYST_INSTRUCTION_SET {

// A tile of `tall` rows and `wide` packs of the matrix, in registers while all rows go by.
template <std::size_t tall, std::size_t wide>
inline void add_tile(const double *rows, std::size_t samples, std::size_t stride, std::size_t i,
                     std::size_t j, double *gram) {
    Pack sum[tall][wide];
#pragma GCC unroll 8
    for (std::size_t a = 0; a < tall; ++a) {
#pragma GCC unroll 2
        for (std::size_t b = 0; b < wide; ++b) {
            sum[a][b] = load(gram + (i + a) * stride + j + b * kWidth);
        }
    }
    for (std::size_t k = 0; k < samples; ++k) {
        const double *row = rows + k * stride;
#pragma GCC unroll 8
        for (std::size_t a = 0; a < tall; ++a) {
#pragma GCC unroll 2
            for (std::size_t b = 0; b < wide; ++b) {
                sum[a][b] += row[i + a] * load(row + j + b * kWidth);
            }
        }
    }
#pragma GCC unroll 8
    for (std::size_t a = 0; a < tall; ++a) {
#pragma GCC unroll 2
        for (std::size_t b = 0; b < wide; ++b) {
            store(gram + (i + a) * stride + j + b * kWidth, sum[a][b]);
        }
    }
}

// width is what is wanted of stride columns; stride is a multiple of 8.
inline void add_gram(const double *rows, std::size_t samples, std::size_t width, std::size_t stride,
                     double *gram) {
    constexpr std::size_t tall = 4;
    for (std::size_t i = 0; i < width; i += tall) {
        std::size_t j = 0;
        for (; j + kWidth < i + tall && j + 2 * kWidth <= stride; j += 2 * kWidth) {
            add_tile<tall, 2>(rows, samples, stride, i, j, gram);
        }
        for (; j < i + tall; j += kWidth) add_tile<tall, 1>(rows, samples, stride, i, j, gram);
    }
}

}  // namespace hyst::HYST_INSTRUCTION_SET
