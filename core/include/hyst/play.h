/* Play (backlash) and stop (elastic-plastic) operators of one threshold r >= 0.
 *
 * Play (S1 eq. 2, S4 eq. 4):  z_k = max(u_k - r, min(u_k + r, z_{k-1}))
 * Stop:                       y_k = u_k - z_k
 *
 * The state of either is the play's output z. Initially z = 0: no memory. */
#ifndef HYST_PLAY_H
#define HYST_PLAY_H

#include "hyst/kind.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

/* z moved no further than into [low, high]. Comparisons instead of fmin and fmax: no libm, and six
 * times faster. */
static inline hyst_real hyst_clamp(hyst_real low, hyst_real high, hyst_real z)
{
    const hyst_real below = HYST_SELECT(z < high, z, high);
    return HYST_SELECT(below > low, below, low);
}

/* The play's equation, for all files of the core: clamp z to [u - r, u + r]. */
static inline hyst_real hyst_play(hyst_real u, hyst_real r, hyst_real z)
{
    return hyst_clamp(u - r, u + r, z);
}

/* One sample of the play; returns the new z, which is also stored. */
hyst_real hyst_play_step(hyst_real r, hyst_real *z, hyst_real u);

/* One sample of the stop; z is the state of the play it is built on. */
hyst_real hyst_stop_step(hyst_real r, hyst_real *z, hyst_real u);

extern const hyst_kind hyst_play_kind; /* of a threshold, hyst_real */
extern const hyst_kind hyst_stop_kind; /* of a threshold, hyst_real */

#ifdef HYST_EXTERN_C
}
#endif

#endif
