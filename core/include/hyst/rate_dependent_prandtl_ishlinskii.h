/* Prandtl-Ishlinskii operator whose thresholds grow with the rate of the input (S4 eqs. 2-7):
 *   y_k = p0 u_k + sum_i p_i z_i,   z_i = play of threshold r_i + b_k,   b_k = g(|u_k - u_{k-1}|)
 * where g is a curve with g(0) = 0; growth = beta / dt >= 0 alone gives S4 eq. 24:
 *   g(x) = growth x + power_0 x^2 + power_1 x^3 + ... + sum_j weight_j max(x - threshold_j, 0)
 *
 * The bounds of a play are formed as (u - b) - r and (u + b) + r: what depends on the sample first,
 * so that all plays share it and the order of the bounds survives rounding. */
#ifndef HYST_RATE_DEPENDENT_PRANDTL_ISHLINSKII_H
#define HYST_RATE_DEPENDENT_PRANDTL_ISHLINSKII_H

#include "hyst/dead_zone.h"
#include "hyst/kind.h"
#include "hyst/prandtl_ishlinskii.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    hyst_pi pi;             /* weights, and thresholds at rest */
    hyst_real growth;       /* beta / dt: widening of every threshold per unit of |u_k - u_{k-1}| */
    size_t powers;          /* further terms of g, none of them in the linear case */
    const hyst_real *power; /* coefficients of x^2, x^3, .. */
    hyst_dead_zone ramps;   /* thresholds > 0, in units of |u_k - u_{k-1}| */
} hyst_rate_dependent_pi;

/* g(x) for x >= 0. A result that is no number >= 0 counts as 0: the state stays finite. */
hyst_real hyst_widening(const hyst_rate_dependent_pi *model, hyst_real x);

/* One sample. The state holds the count play outputs, the previous input, and 1 once there is a
 * previous input (0 before the first sample, whose rate is 0). */
hyst_real hyst_rate_dependent_pi_step(const hyst_rate_dependent_pi *model, hyst_real *state,
                                      hyst_real u);

extern const hyst_kind hyst_rate_dependent_pi_kind; /* of a hyst_rate_dependent_pi */

#ifdef HYST_EXTERN_C
}
#endif

#endif
