/* Projection onto 0 <= x_1 <= .. <= x_n, in the Euclidean sense: pool adjacent violators.
 *
 * At most n (n + 1) / 2 comparisons and n divisions; n comparisons where the order holds already. */
#ifndef HYST_ISOTONIC_H
#define HYST_ISOTONIC_H

#include "hyst/real.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The ascending x within [lower, upper] that is nearest to the given one, in its place.
 * The bounds are common to all, so clamping the ascending x gives the projection onto both. */
void hyst_isotonic(size_t count, hyst_real *x, hyst_real lower, hyst_real upper);

#ifdef __cplusplus
}
#endif

#endif
