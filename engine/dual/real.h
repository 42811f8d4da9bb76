/* A number with HYST_TANGENTS derivatives: HYST_REAL_HEADER of hyst/real.h.
 *
 * The values of +, -, *, / are those of double, comparisons look at the values alone; so a step of
 * the core takes the branches it takes in double and gives the same bits, and beside them its
 * derivative. Included inside a namespace, by core.hpp, after <stddef.h>. */

/* Tangents in packs as wide as the instruction set, each of which the optimizer keeps in a register.
 * The layout is the same for all instruction sets. */
#if defined(__AVX512F__) && HYST_TANGENTS >= 8
#define HYST_PACK 8
#elif defined(__AVX__)
#define HYST_PACK 4
#else
#define HYST_PACK 2
#endif

#define HYST_EACH_PACK(result, expression)                                        \
    Tangent result;                                                               \
    for (int i = 0; i < HYST_TANGENTS / HYST_PACK; ++i) result.pack[i] = expression; \
    return result
#define HYST_INLINE static inline __attribute__((always_inline))

struct Tangent {
    typedef double Pack __attribute__((vector_size(8 * HYST_PACK)));
    Pack pack[HYST_TANGENTS / HYST_PACK];
};

HYST_INLINE Tangent operator+(Tangent a, Tangent b) { HYST_EACH_PACK(c, a.pack[i] + b.pack[i]); }
HYST_INLINE Tangent operator-(Tangent a, Tangent b) { HYST_EACH_PACK(c, a.pack[i] - b.pack[i]); }
HYST_INLINE Tangent operator-(Tangent a) { HYST_EACH_PACK(c, -a.pack[i]); }
HYST_INLINE Tangent operator*(double a, Tangent b) { HYST_EACH_PACK(c, a * b.pack[i]); }
HYST_INLINE Tangent operator/(Tangent a, double b) { HYST_EACH_PACK(c, a.pack[i] / b); }

struct alignas(HYST_TANGENTS >= 8 ? 64 : 32) hyst_real {
    Tangent d;
    double v;

    hyst_real() = default;
    hyst_real(const hyst_real &) = default;
    constexpr hyst_real(double value) : d{}, v(value) {}
    hyst_real(double value, Tangent tangent) : d(tangent), v(value) {}
    explicit operator size_t() const { return static_cast<size_t>(v); }
    /* Part for part: gcc copies a large structure in small pieces by way of memory. */
    __attribute__((always_inline)) hyst_real &operator=(const hyst_real &other)
    {
        for (int i = 0; i < HYST_TANGENTS / HYST_PACK; ++i) d.pack[i] = other.d.pack[i];
        v = other.v;
        return *this;
    }
};

HYST_INLINE hyst_real operator*(hyst_real a, hyst_real b)
{
    return {a.v * b.v, a.v * b.d + b.v * a.d};
}
HYST_INLINE hyst_real operator/(hyst_real a, hyst_real b)
{
    const double quotient = a.v / b.v;
    return {quotient, (a.d - quotient * b.d) / b.v};
}
#include "arithmetic.h"

/* Part for part too: a choice between two structures goes by way of memory, ten times slower. */
HYST_INLINE hyst_real hyst_select(bool condition, hyst_real a, hyst_real b)
{
    hyst_real chosen = b;
    chosen.v = condition ? a.v : b.v;
    for (int i = 0; i < HYST_TANGENTS / HYST_PACK; ++i) {
        chosen.d.pack[i] = condition ? a.d.pack[i] : b.d.pack[i];
    }
    return chosen;
}

#define HYST_REAL(literal) literal
#define HYST_SELECT(condition, a, b) hyst_select(condition, a, b)
#define HYST_ROUNDED(exact, rounded) hyst_real((rounded).v, (exact).d)
