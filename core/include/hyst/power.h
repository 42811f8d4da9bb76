/* x to the power e, and the base-2 logarithm and exponential it is made of: the only functions of
 * the core that other libraries take from libm.
 *
 * It is written out here in plain arithmetic for two reasons: the core asks nothing of a target but
 * a compiler, and the libm of every platform rounds its own way, while these lines give the same
 * bits everywhere. A firmware that has something better names its header:
 *   -DHYST_POWER_HEADER='"my_power.h"'
 * which must define hyst_power for x >= 0 and any finite e, hyst_log2 for x > 0, and hyst_exp2, 0 or an
 * infinity where that is out of range.
 *
 * x = m 2^k with m in [sqrt(1/2), sqrt(2));  log2 m = 2 / ln 2 artanh((m - 1) / (m + 1)), a series in
 * t^2 <= 0.02945;  x^e = 2^n exp(r ln 2) with n + r = e log2 x, |r| <= 1/2, a series too.
 * The relative error is at most (4 + 2 |e log2 x|) times the machine epsilon. */
#ifndef HYST_POWER_H
#define HYST_POWER_H

#include "hyst/real.h"

#ifdef HYST_POWER_HEADER
#include HYST_POWER_HEADER
#else

#include <stdint.h>

#ifdef HYST_EXTERN_C
extern "C" {
#endif

#ifdef HYST_SINGLE
typedef uint32_t hyst_bits;
#define HYST_MANTISSA_BITS 23
#define HYST_EXPONENT_BIAS 127
#define HYST_ONE_BITS 0x3f800000u
#define HYST_ROOT_HALF_BITS 0x3f3504f3u
#define HYST_LEAST_NORMAL 1.17549435e-38f
#define HYST_SCALE_UP 16777216.0f /* 2^24 */
#define HYST_SCALE_UP_EXPONENT 24
#define HYST_UNIT 8388608.0f /* 2^23 */
#define HYST_UNIT_BITS 0x4b000000u
#else
typedef uint64_t hyst_bits;
#define HYST_MANTISSA_BITS 52
#define HYST_EXPONENT_BIAS 1023
#define HYST_ONE_BITS UINT64_C(0x3ff0000000000000)
#define HYST_ROOT_HALF_BITS UINT64_C(0x3fe6a09e667f3bcd)
#define HYST_LEAST_NORMAL 2.2250738585072014e-308
#define HYST_SCALE_UP 18014398509481984.0 /* 2^54 */
#define HYST_SCALE_UP_EXPONENT 54
#define HYST_UNIT 4503599627370496.0 /* 2^52 */
#define HYST_UNIT_BITS UINT64_C(0x4330000000000000)
#endif

typedef union {
    hyst_real value;
    hyst_bits bits;
} hyst_pattern;

/* Base-2 logarithm of a finite x > 0. */
static inline hyst_real hyst_log2(hyst_real x)
{
    const hyst_bits mantissa = ((hyst_bits)1 << HYST_MANTISSA_BITS) - 1u;
    const int is_small = x < HYST_LEAST_NORMAL;
    const hyst_real offset = is_small ? HYST_EXPONENT_BIAS + HYST_SCALE_UP_EXPONENT
                                      : HYST_EXPONENT_BIAS;
    hyst_pattern m, whole;
    hyst_bits shifted;
    m.value = is_small ? x * HYST_SCALE_UP : x;
    shifted = m.bits + (HYST_ONE_BITS - HYST_ROOT_HALF_BITS);
    m.bits = (shifted & mantissa) + HYST_ROOT_HALF_BITS;
    /* The exponent as a number: placed in the last bits of 2^52 (2^23), where units are counted. */
    whole.bits = (shifted >> HYST_MANTISSA_BITS) | HYST_UNIT_BITS;
    const hyst_real k = (whole.value - HYST_UNIT) - offset;

    const hyst_real t = (m.value - HYST_REAL(1.0)) / (m.value + HYST_REAL(1.0));
    const hyst_real s = t * t;
    const hyst_real s2 = s * s;
    /* 1/3 + s/5 + .. + s^9/21, even and odd powers apart so that a processor overlaps them. */
    const hyst_real even =
        HYST_REAL(0.3333333333333333) +
        s2 * (HYST_REAL(0.14285714285714285) +
              s2 * (HYST_REAL(0.09090909090909091) +
                    s2 * (HYST_REAL(0.06666666666666667) + s2 * HYST_REAL(0.05263157894736842))));
    const hyst_real odd =
        HYST_REAL(0.2) +
        s2 * (HYST_REAL(0.1111111111111111) +
              s2 * (HYST_REAL(0.07692307692307693) +
                    s2 * (HYST_REAL(0.058823529411764705) + s2 * HYST_REAL(0.047619047619047616))));
    const hyst_real artanh = t + t * (s * (even + s * odd));
    return k + HYST_REAL(2.8853900817779268) * artanh;
}

/* 2 to the power v; 0 or an infinity where that is out of range. */
static inline hyst_real hyst_exp2(hyst_real v)
{
    const hyst_real most = (hyst_real)(HYST_EXPONENT_BIAS + 5);
    const hyst_real least = -(hyst_real)(HYST_EXPONENT_BIAS + HYST_MANTISSA_BITS + 5);
    hyst_pattern half, rest;
    v = v < most ? v : most;
    v = v > least ? v : least;
    const int n = (int)(v + (v < HYST_REAL(0.0) ? HYST_REAL(-0.5) : HYST_REAL(0.5)));
    const hyst_real z = HYST_REAL(0.6931471805599453) * (v - (hyst_real)n);
    const hyst_real z2 = z * z;
    /* Taylor to z^13, even and odd powers apart. */
    const hyst_real even =
        HYST_REAL(0.5) +
        z2 * (HYST_REAL(0.041666666666666664) +
              z2 * (HYST_REAL(0.001388888888888889) +
                    z2 * (HYST_REAL(2.48015873015873e-05) +
                          z2 * (HYST_REAL(2.755731922398589e-07) +
                                z2 * HYST_REAL(2.08767569878681e-09)))));
    const hyst_real odd =
        HYST_REAL(0.16666666666666666) +
        z2 * (HYST_REAL(0.008333333333333333) +
              z2 * (HYST_REAL(0.0001984126984126984) +
                    z2 * (HYST_REAL(2.7557319223985893e-06) +
                          z2 * (HYST_REAL(2.505210838544172e-08) +
                                z2 * HYST_REAL(1.6059043836821613e-10)))));
    const hyst_real exponential = HYST_REAL(1.0) + (z + z2 * (even + z * odd));
    /* 2^n in two factors, so that a result that is subnormal or infinite comes about by itself. */
    half.bits = (hyst_bits)(HYST_EXPONENT_BIAS + n / 2) << HYST_MANTISSA_BITS;
    rest.bits = (hyst_bits)(HYST_EXPONENT_BIAS + (n - n / 2)) << HYST_MANTISSA_BITS;
    return exponential * half.value * rest.value;
}

static inline hyst_real hyst_power(hyst_real x, hyst_real e)
{
    /* Without a branch, so that a compiler may take many x at once. */
    const hyst_real result = hyst_exp2(e * hyst_log2(x));
    return x > HYST_REAL(0.0) ? result : HYST_REAL(0.0);
}

#ifdef HYST_EXTERN_C
}
#endif

#endif
#endif
