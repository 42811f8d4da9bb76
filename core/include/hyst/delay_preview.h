/* Inverse of a delay by a fraction f > 1/2 of a sample that knows n more samples of what is late.
 *
 *     y_k = (1 - f) u_k + f u_{k-1},   so   u_{k-1} = y_k + q (y_k - u_k),   q = (1 - f) / f < 1
 *
 * From the newest sample on, as if the output had rested there, back to the one that is wanted: what is
 * wrong with the beginning grows smaller by q with every sample. The step costs n multiplications.
 *
 * State: the place where the next sample goes, how many samples are held, and the last n + 1 of y in a
 * ring. Before the first sample y has rested at it. */
#ifndef HYST_DELAY_PREVIEW_H
#define HYST_DELAY_PREVIEW_H

#include "hyst/kind.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    size_t ahead;   /* n */
    hyst_real lead; /* q, from 0 to below 1 */
} hyst_delay_preview;

/* One sample: u_{k-1-n} from y up to y_k. What is not finite is answered and the state kept. */
hyst_real hyst_delay_preview_step(const hyst_delay_preview *model, hyst_real *state, hyst_real y);

extern const hyst_kind hyst_delay_preview_kind; /* of a hyst_delay_preview */

#ifdef HYST_EXTERN_C
}
#endif

#endif
