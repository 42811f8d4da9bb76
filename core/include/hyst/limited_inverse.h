/* An inverse in front of an actuator whose drive is limited.
 *
 *   u = inverse(v);   where u may not be: u_a, the nearest that may, and v_a = forward(u_a)
 *
 * forward is the exact inverse of the inverse. It is stepped with the drive that is applied, so that
 * its memory is the actuator's; where the drive is held, the inverse is stepped anew with v_a, to
 * which u_a belongs, so that its memory is that of an actuator driven by u_a. Where no drive belongs
 * to v, the last one is kept.
 *
 * State: that of the inverse, that of forward, the last drive (within the limits at start). */
#ifndef HYST_LIMITED_INVERSE_H
#define HYST_LIMITED_INVERSE_H

#include "hyst/chain.h"
#include "hyst/drive_limits.h"
#include "hyst/guard.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    hyst_chain inverse; /* from v to u */
    hyst_chain forward; /* from u to v, its exact inverse */
    hyst_drive_limits limits;
} hyst_limited_inverse;

typedef struct {
    hyst_guard guard; /* y_last: within the limits at start */
    int limited;      /* 0, or 1 since the first sample whose drive was not that of the inverse */
} hyst_limited_guard;

size_t hyst_limited_inverse_state_length(const hyst_limited_inverse *limited);

/* One sample of anything: see guard.h. *v becomes the v_a that belongs to the drive, and stays as it is
 * where the drive is that of the inverse. If *v is not finite, no state changes.
 * before: room for the state of the inverse; what is in it counts for nothing. */
hyst_real hyst_limited_inverse_step(const hyst_limited_inverse *limited, hyst_real *state,
                                    hyst_real *before, hyst_limited_guard *guard, hyst_real *v);

#ifdef HYST_EXTERN_C
}
#endif

#endif
