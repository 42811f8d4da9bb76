/* Whether a number is finite, without libm and without a call. */
#ifndef HYST_FINITE_H
#define HYST_FINITE_H

#include "hyst/real.h"

/* Such options let a compiler take for granted that there are no NaNs, and drop every check. */
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error "compile without -ffast-math and -ffinite-math-only: they remove the checks for NaN"
#endif

#ifdef HYST_EXTERN_C
extern "C" {
#endif

/* 1 for a finite number, 0 for an infinity or a NaN. */
static inline int hyst_is_finite(hyst_real value)
{
    /* inf - inf and NaN - NaN are NaN, and a NaN is not equal to zero. */
    const hyst_real difference = value - value;
    return difference >= HYST_REAL(0.0) && difference <= HYST_REAL(0.0);
}

#ifdef HYST_EXTERN_C
}
#endif

#endif
