/* What a firmware may name with HYST_POWER_HEADER: a power function of its own. This one is libm's, and
 * it counts how often it is taken. */
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

#endif
