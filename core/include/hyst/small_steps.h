/* ln(1 + x) and exp(x) - 1 with the digits of a small x, over a factor that may be 0. */
#ifndef HYST_SMALL_STEPS_H
#define HYST_SMALL_STEPS_H

#include "hyst/power.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

/* Below this size of v the logarithm of 1 + v is summed, since 1 + v has lost digits of v. */
#define HYST_SMALL_STEP HYST_REAL(0.25)
#define HYST_NATURAL_OF_2 HYST_REAL(0.6931471805599453)
#define HYST_BINARY_OF_E HYST_REAL(1.4426950408889634)

/* ln(1 + m t) / m, and its limit t where m is 0; v = m t > -1. */
static inline hyst_real hyst_small_logarithm(hyst_real m, hyst_real t)
{
    const hyst_real v = m * t;
    if (v < HYST_SMALL_STEP && v > -HYST_SMALL_STEP) {
        /* 2 artanh(q) / m with q = v / (2 + v), the m taken out before it can divide. */
        const hyst_real q = v / (HYST_REAL(2.0) + v);
        const hyst_real s = q * q;
        hyst_real sum = HYST_REAL(0.0);
        for (size_t k = 10; k > 0u; --k) {
            sum = (sum + HYST_REAL(1.0) / (hyst_real)(2u * k + 1u)) * s;
        }
        return HYST_REAL(2.0) * t / (HYST_REAL(2.0) + v) * (HYST_REAL(1.0) + sum);
    }
    return HYST_NATURAL_OF_2 * hyst_log2(HYST_REAL(1.0) + v) / m;
}

/* (exp(m l) - 1) / m, and its limit l where m is 0. */
static inline hyst_real hyst_small_exponential(hyst_real m, hyst_real l)
{
    const hyst_real v = m * l;
    if (v < HYST_SMALL_STEP && v > -HYST_SMALL_STEP) {
        hyst_real sum = HYST_REAL(1.0);
        for (size_t k = 13; k > 1u; --k) {
            sum = HYST_REAL(1.0) + sum * v / (hyst_real)k;
        }
        return l * sum;
    }
    return (hyst_exp2(HYST_BINARY_OF_E * v) - HYST_REAL(1.0)) / m;
}

#ifdef HYST_EXTERN_C
}
#endif

#endif
