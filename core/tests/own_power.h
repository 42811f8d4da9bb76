/* What a firmware may name with HYST_POWER_HEADER: power, logarithm and exponential of its
 * own. These are libm's, and powers are counted. */
#ifndef OWN_POWER_H
#define OWN_POWER_H

#include <math.h>

#include "hyst/real.h"

extern int own_powers_taken;

static inline hyst_real hyst_power(hyst_real x, hyst_real e)
{
    ++own_powers_taken;
#ifdef HYST_SINGLE
    return powf(x, e);
#else
    return pow(x, e);
#endif
}

static inline hyst_real hyst_log2(hyst_real x) { return (hyst_real)log2((double)x); }

static inline hyst_real hyst_exp2(hyst_real v) { return (hyst_real)exp2((double)v); }

#endif
