/* A tracking controller that knows the limits of its drive.
 *
 *   v_k = c x_k + d0 y_ref_k + d1 y_k,   u_k, v_a,k = limited inverse(v_k),
 *   x_{k+1} = A x_k + B [y_ref_k; y_k] + w (v_a,k - v_k)
 *
 * v_a is the v that belongs to the drive that was applied. On samples whose drive is not limited all
 * bits are those of the controller without limits.
 *
 * State: x_1 .. x_n, then the state of the limited inverse. */
#ifndef HYST_LIMITED_TRACKING_H
#define HYST_LIMITED_TRACKING_H

#include "hyst/limited_inverse.h"
#include "hyst/real.h"
#include "hyst/tracking_controller.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    hyst_tracking_controller linear; /* its own inverse counts for nothing */
    const hyst_real *w;              /* n: what x takes back of what the drive could not do */
    hyst_limited_inverse inverse;
} hyst_limited_tracking;

size_t hyst_limited_tracking_state_length(const hyst_limited_tracking *controller);

/* One sample of anything: see limited_inverse.h, also for `before`. If y_ref or y is not finite, no
 * state changes. *v becomes the v that belongs to the drive, and *excess that minus the v that was
 * wanted; both stay as they are where no state changes. */
hyst_real hyst_limited_tracking_step(const hyst_limited_tracking *controller, hyst_real *state,
                                     hyst_real *before, hyst_limited_guard *guard, hyst_real y_ref,
                                     hyst_real y, hyst_real *v, hyst_real *excess);

#ifdef HYST_EXTERN_C
}
#endif

#endif
