/* A first-order lag tau y' = u - y, sampled, and its exact inverse.
 *
 *     y_k = y_{k-1} + g (u_{k-1} - y_{k-1}) + b (u_k - u_{k-1}),   g = 1 - exp(-dt / tau)
 *
 * Where u is a line between samples, b = 1 - g tau / dt; where u_k is held until y_k is read, b = g. The
 * signal has rested at its first sample, which passes as it is.
 *
 * The inverse is the same equation solved for u_k; then it takes the step that the lag will take of it,
 * so that what rounding leaves is not added up from sample to sample. What rounding leaves of a step is
 * carried to the next one, as in hyst/creep.h.
 *
 * State: y, what is carried, u, and whether there was a sample. */
#ifndef HYST_LAG_H
#define HYST_LAG_H

#include "hyst/creep.h"
#include "hyst/kind.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    hyst_real gain;        /* g, between 0 and 1 */
    hyst_real through;     /* b, between 0 and g */
    hyst_real per_through; /* 1 / b */
    int inverse;           /* whether the input is y */
} hyst_lag;

/* b of a line between samples, its time constant so many of them: 1 - (1 - exp(-x)) / x, where x is
 * small by its series x / 2! - x^2 / 3! + x^3 / 4! - .. */
static inline hyst_real hyst_lag_through(hyst_real samples)
{
    const hyst_real one = HYST_REAL(1.0);
    const hyst_real x = one / samples;
    if (x < one) {
        hyst_real sum = one;
        for (size_t k = 20; k > 2u; --k) {
            sum = one - sum * x / (hyst_real)k;
        }
        return HYST_REAL(0.5) * x * sum;
    }
    return one - hyst_creep_gain(samples) * samples;
}

/* One sample. What is not finite, or would make the state so, is answered and the state kept. */
hyst_real hyst_lag_step(const hyst_lag *model, hyst_real *state, hyst_real input);

extern const hyst_kind hyst_lag_kind; /* of a hyst_lag */

#ifdef HYST_EXTERN_C
}
#endif

#endif
