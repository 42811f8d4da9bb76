/* A controller that tracks: linear part of two inputs, then the inverse of the hysteresis.
 *
 *   v_k = c x_k + d0 y_ref_k + d1 y_k,   x_{k+1} = A x_k + B [y_ref_k; y_k],   u_k = inverse(v_k)
 *
 * The linear part joins the feedback controller C(z) and the disturbance observer of S1 eq. 32,
 * whose estimate is taken off v (S1 fig. 2); the observer's own dependence on v is already solved for
 * in A, B, c and d. The inverse is a chain; an empty chain gives u = v.
 *
 * State: x_1 .. x_n, then the state of the chain. */
#ifndef HYST_TRACKING_CONTROLLER_H
#define HYST_TRACKING_CONTROLLER_H

#include "hyst/chain.h"
#include "hyst/guard.h"
#include "hyst/linear_dynamics.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    size_t order;       /* n <= HYST_LARGEST_ORDER */
    const hyst_real *a; /* n x n, column after column */
    const hyst_real *b; /* n x 2, column after column: that of y_ref, that of y */
    const hyst_real *c; /* n */
    hyst_real d[2];     /* of y_ref, of y */
    hyst_chain inverse;
} hyst_tracking_controller;

size_t hyst_tracking_controller_state_length(const hyst_tracking_controller *controller);

/* The linear part alone: v, and the next x. Where either would not be finite, x stays as it was and
 * what is returned is not finite. */
hyst_real hyst_tracking_controller_linear(const hyst_tracking_controller *controller, hyst_real *x,
                                          hyst_real y_ref, hyst_real y);

/* What the linear part takes back where `excess` was added to its v behind it: x += w excess. A sum that
 * is not finite is left out as a whole. */
void hyst_tracking_take_back(size_t order, const hyst_real *w, hyst_real *x, hyst_real excess);

/* One sample: reference and measured output in, drive out. Both must be finite. */
hyst_real hyst_tracking_controller_step(const hyst_tracking_controller *controller,
                                        hyst_real *state, hyst_real y_ref, hyst_real y);

/* The same for anything: see guard.h. If y_ref or y is not finite, no state changes. */
hyst_real hyst_guarded_tracking_step(const hyst_tracking_controller *controller, hyst_real *state,
                                     hyst_guard *guard, hyst_real y_ref, hyst_real y);

#ifdef HYST_EXTERN_C
}
#endif

#endif
