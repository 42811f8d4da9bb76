/* Creep of an actuator: first-order lags beside the signal, and its exact inverse.
 *
 *     y_k = u_k + sum_i w_i x_i,k,   x_i,k+1 = x_i,k + g_i (u_k - x_i,k),   g_i = 1 - exp(-dt / tau_i)
 *
 * What the lags answer belongs to the samples before, so the sample itself passes through as it is, and
 * the inverse is the same equation solved for u_k: u_k = y_k - sum_i w_i x_i,k.
 *
 * Time constants of 10^6 samples are common, and a step of a lag is then lost in the digits of x. What
 * rounding leaves of each step is carried to the next one (W. Kahan, Commun. ACM 8 (1965) 40), so that a
 * lag arrives in single precision, too.
 *
 * State: for each lag x and what is carried. */
#ifndef HYST_CREEP_H
#define HYST_CREEP_H

#include "hyst/kind.h"
#include "hyst/real.h"
#include "hyst/small_steps.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    size_t count;            /* lags */
    const hyst_real *weight; /* w */
    const hyst_real *gain;   /* g, between 0 and 1 */
    int inverse;             /* whether the input is y */
} hyst_creep;

/* g of a time constant of so many samples, its digits kept where they are many. */
static inline hyst_real hyst_creep_gain(hyst_real samples)
{
    const hyst_real one = HYST_REAL(1.0);
    return -hyst_small_exponential(one, -(one / samples));
}

/* One sample. What is not finite, or would make a lag so, is answered and the state kept. */
hyst_real hyst_creep_step(const hyst_creep *model, hyst_real *state, hyst_real input);

extern const hyst_kind hyst_creep_kind; /* of a hyst_creep */

#ifdef HYST_EXTERN_C
}
#endif

#endif
