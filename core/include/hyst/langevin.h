/* The Langevin function L(x) = coth x - 1/x of magnetism, its slope and its inverse, with all digits:
 * neither 1/x nor the square of L is subtracted where that would cancel. */
#ifndef HYST_LANGEVIN_H
#define HYST_LANGEVIN_H

#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

/* Steps of Newton's method at most; four are usual. */
#define HYST_LANGEVIN_LIMIT 12u

hyst_real hyst_langevin(hyst_real x);
hyst_real hyst_langevin_slope(hyst_real x);

/* The x with L(x) = v for |v| < 1; beyond, that of the largest v below 1. */
hyst_real hyst_langevin_inverse(hyst_real v);

#ifdef HYST_EXTERN_C
}
#endif

#endif
