/* The square root of a number in [0, 8], by plain arithmetic: the core calls no libm, and the same
 * bits come out everywhere.
 *
 * From half the exponent, four steps of Newton's method for 1/sqrt(x) (three in single precision) and
 * one of Heron's. The relative error is at most one machine epsilon; below 1e-30 it answers 0. */
#ifndef HYST_ROOT_H
#define HYST_ROOT_H

#include "hyst/real.h"

#ifdef HYST_ROOT_HEADER
#include HYST_ROOT_HEADER
#else

#include <stdint.h>

#ifdef HYST_EXTERN_C
extern "C" {
#endif

#ifdef HYST_SINGLE
typedef uint32_t hyst_root_bits;
#define HYST_ROOT_SEED 0x5f3759dfu
#define HYST_ROOT_STEPS 3u
#else
typedef uint64_t hyst_root_bits;
#define HYST_ROOT_SEED UINT64_C(0x5fe6eb50c7b537a9)
#define HYST_ROOT_STEPS 4u
#endif

typedef union {
    hyst_real value;
    hyst_root_bits bits;
} hyst_root_pattern;

static inline hyst_real hyst_root(hyst_real x)
{
    const hyst_real half = HYST_REAL(0.5) * x;
    hyst_root_pattern r;
    r.value = x;
    r.bits = HYST_ROOT_SEED - (r.bits >> 1);
    for (size_t k = 0; k < HYST_ROOT_STEPS; ++k) {
        r.value = r.value * (HYST_REAL(1.5) - half * r.value * r.value);
    }
    const hyst_real root = x * r.value;
    const hyst_real better = root + HYST_REAL(0.5) * r.value * (x - root * root);
    return x > HYST_REAL(1e-30) ? better : HYST_REAL(0.0);
}

#ifdef HYST_EXTERN_C
}
#endif

#endif
#endif
