// A pack of doubles that one instruction works on, in the compiler's own vector extension.
//
// This header is compiled once per instruction set, each time in a namespace of its own
// (HYST_INSTRUCTION_SET), so that no function built for a newer processor can be taken for one of
// an older. For the same reason nothing here or in the kernels calls an inline function of the
// standard library.
//
// Invariant: smaller(a, b) and larger(a, b) are the core's comparisons, lane by lane, down to the
// sign of zero. Compilers turn them into one min or max instruction each.
#pragma once

#include <cstddef>

#if defined(__FMA__)
#include <immintrin.h>
#endif

#if !defined(HYST_INSTRUCTION_SET)
#error "compile the kernels with -DHYST_INSTRUCTION_SET=a_name"
#endif

namespace hyst::HYST_INSTRUCTION_SET {

#if defined(__AVX512F__)
constexpr std::size_t kWidth = 8;
#elif defined(__AVX2__)
constexpr std::size_t kWidth = 4;
#else
constexpr std::size_t kWidth = 2;
#endif

using Pack = double __attribute__((vector_size(kWidth * sizeof(double))));
using Mask = decltype(Pack{} < Pack{});  // all bits of a lane set where a comparison holds

inline Pack load(const double *from) {
    Pack pack;
    __builtin_memcpy(&pack, from, sizeof pack);
    return pack;
}

inline void store(double *to, Pack pack) { __builtin_memcpy(to, &pack, sizeof pack); }

inline Pack broadcast(double value) { return value - Pack{}; }

inline Pack smaller(Pack a, Pack b) { return a < b ? a : b; }
inline Pack larger(Pack a, Pack b) { return a > b ? a : b; }

inline Pack magnitude(Pack a) {
    constexpr long long without_sign = 0x7fffffffffffffff;
    return reinterpret_cast<Pack>(reinterpret_cast<Mask>(a) & without_sign);
}

// a + b and a - b, bit for bit, on the execution units that multiply: 1 a + b is exact but for the
// one rounding of the sum. The units that add have the min, the max and the sum of a play to do.
#if defined(__AVX512F__)
inline Pack plus(Pack a, Pack b) { return _mm512_fmadd_pd(broadcast(1.0), a, b); }
inline Pack minus(Pack a, Pack b) { return _mm512_fmsub_pd(broadcast(1.0), a, b); }
#elif defined(__FMA__)
inline Pack plus(Pack a, Pack b) { return _mm256_fmadd_pd(broadcast(1.0), a, b); }
inline Pack minus(Pack a, Pack b) { return _mm256_fmsub_pd(broadcast(1.0), a, b); }
#else
inline Pack plus(Pack a, Pack b) { return a + b; }
inline Pack minus(Pack a, Pack b) { return a - b; }
#endif

// The play of core/include/hyst/play.h between two bounds, in all lanes.
inline Pack clamp(Pack low, Pack high, Pack z) { return larger(smaller(z, high), low); }

// A comparison as bits, the first lane lowest.
inline unsigned bits(Mask mask) {
#if defined(__AVX512F__)
    return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask));
#elif defined(__AVX2__)
    return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask)));
#else
    return static_cast<unsigned>((mask[0] & 1) | (mask[1] & 2));
#endif
}

inline bool any(Mask mask) { return bits(mask) != 0; }

// Rows a and b of a square, `size` apart, swap what lies `size` beside the diagonal of their blocks.
template <std::size_t size>
inline void swap_blocks(Pack &a, Pack &b);

#if defined(__AVX512F__)
template <>
inline void swap_blocks<1>(Pack &a, Pack &b) {
    const Pack first = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
    b = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
    a = first;
}
template <>
inline void swap_blocks<2>(Pack &a, Pack &b) {
    const Pack first = __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
    b = __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
    a = first;
}
template <>
inline void swap_blocks<4>(Pack &a, Pack &b) {
    const Pack first = __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11);
    b = __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15);
    a = first;
}
#elif defined(__AVX2__)
template <>
inline void swap_blocks<1>(Pack &a, Pack &b) {
    const Pack first = __builtin_shufflevector(a, b, 0, 4, 2, 6);
    b = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    a = first;
}
template <>
inline void swap_blocks<2>(Pack &a, Pack &b) {
    const Pack first = __builtin_shufflevector(a, b, 0, 1, 4, 5);
    b = __builtin_shufflevector(a, b, 2, 3, 6, 7);
    a = first;
}
#else
template <>
inline void swap_blocks<1>(Pack &a, Pack &b) {
    const Pack first = __builtin_shufflevector(a, b, 0, 2);
    b = __builtin_shufflevector(a, b, 1, 3);
    a = first;
}
#endif

// Transposes the square rows[0..kWidth): blocks of 1, 2, 4 change sides of the diagonal.
template <std::size_t size = 1>
inline void transpose(Pack *rows) {
    if constexpr (size < kWidth) {
#pragma GCC unroll 8
        for (std::size_t j = 0; j < kWidth; ++j) {
            if ((j & size) == 0) swap_blocks<size>(rows[j], rows[j + size]);
        }
        transpose<2 * size>(rows);
    }
}

}  // namespace hyst::HYST_INSTRUCTION_SET
