/* Projection onto 0 <= x_1 <= .. <= x_n: pool adjacent violators.
 *
 * At most n (n + 1) / 2 comparisons and n divisions; n comparisons where the order holds already. */
#ifndef HYST_ISOTONIC_H
#define HYST_ISOTONIC_H

#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

/* The ascending x within [lower, upper] that is nearest to the given one, in its place.
 * The bounds are common to all, so clamping the ascending x gives the projection onto both. */
void hyst_isotonic(size_t count, hyst_real *x, hyst_real lower, hyst_real upper);

/* The same, nearest in sum (x - given)^2 / gain: what a gradient step of these gains >= 0 must be
 * projected in. Nearest in the Euclidean sense, an x of large gain would push its neighbour of small
 * gain to and fro, and the step that approaches the truth could lead away from it. An x of gain 0
 * stays where it is. A further n (n + 1) / 2 divisions at most. */
void hyst_isotonic_weighted(size_t count, hyst_real *x, const hyst_real *gain, hyst_real lower,
                            hyst_real upper);

#ifdef HYST_EXTERN_C
}
#endif

#endif
