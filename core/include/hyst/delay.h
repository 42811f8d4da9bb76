/* A delay of n whole samples and a fraction f of one, on the line between two samples; and the exact
 * inverse where it is less than half a sample.
 *
 *     y_k = (1 - f) u_{k-n} + f u_{k-n-1}
 *
 * The signal has rested at its first sample. The inverse, of n = 0 and f < 1/2, is the same equation
 * solved for u_k.
 *
 * State: the place where the next sample goes, how many samples are held, and the last n + 1 of them in
 * a ring. */
#ifndef HYST_DELAY_H
#define HYST_DELAY_H

#include "hyst/kind.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    size_t whole;       /* n, at most 10^5, which a number in single precision counts exactly */
    hyst_real fraction; /* f, from 0 to 1 */
    hyst_real lead;     /* f / (1 - f) of the inverse */
    int inverse;        /* whether the input is y; then n = 0 and f < 1/2 */
} hyst_delay;

/* One sample. What is not finite, or would make the state so, is answered and the state kept. */
hyst_real hyst_delay_step(const hyst_delay *model, hyst_real *state, hyst_real input);

extern const hyst_kind hyst_delay_kind; /* of a hyst_delay */

#ifdef HYST_EXTERN_C
}
#endif

#endif
