/* The generalized Maxwell-slip model of friction: elements that stick as springs and slide at their
 * share of the Stribeck curve s(v), with a memory in sliding.
 *
 *     sticking   dF_i/dt = k_i v                          until F_i = alpha_i s(v) sgn v
 *     sliding    dF_i/dt = C (alpha_i sgn v - F_i / s(v))   until v turns or rests
 *     F = sum_i F_i + sigma2 v
 *
 * V. Lampaert, J. Swevers and F. Al-Bender, Modification of the Leuven integrated friction model
 * structure, IEEE Trans. Automatic Control 47 (2002) 683-687; F. Al-Bender, V. Lampaert and J. Swevers,
 * The generalized Maxwell-slip model: a novel model for friction simulation and compensation, IEEE
 * Trans. Automatic Control 50 (2005) 1883-1887, eqs. 6-8 (s there has the sign of v).
 *
 * The velocity is constant from sample to sample, v = (u_k - u_{k-1}) / dt, so a sample is exact: an
 * element that sticks slides from where it meets alpha_i s(v), and stays there, and one that slides
 * approaches it by exp(-C dt / s(v)). The force is that at the end of the sample, at u_k, while its
 * velocity still lasts.
 *
 * State: of each element its force, what rounding has left out of it, and the way it slides (-1, 0 for
 * sticking, 1); then the position of the last sample, and 1 once there is one (0 before the first
 * sample, whose velocity is 0).
 *
 * Without velocity in it, alpha_i s constant, this is the Maxwell-slip model, a bank of stops; as plays
 * of weights -k_i and thresholds f_i / k_i beside a spring of sum k_i it is hyst_pi. */
#ifndef HYST_GENERALIZED_MAXWELL_SLIP_H
#define HYST_GENERALIZED_MAXWELL_SLIP_H

#include "hyst/kind.h"
#include "hyst/real.h"
#include "hyst/stribeck.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    size_t count;
    const hyst_real *stiffness; /* k_i > 0 */
    const hyst_real *share;     /* alpha_i > 0 */
    hyst_stribeck curve;
    hyst_real shape;      /* delta > 0 of the curve */
    hyst_real attraction; /* C dt >= 0, a force: how far sliding approaches the curve in a sample */
    hyst_real viscosity;  /* sigma2 >= 0 */
    hyst_real rate;       /* 1 / dt */
} hyst_generalized_maxwell_slip;

/* One sample. A force beyond every number is answered by what is not finite, the state unchanged. */
hyst_real hyst_generalized_maxwell_slip_step(const hyst_generalized_maxwell_slip *model,
                                             hyst_real *state, hyst_real u);

extern const hyst_kind hyst_generalized_maxwell_slip_kind; /* of a hyst_generalized_maxwell_slip */

#ifdef HYST_EXTERN_C
}
#endif

#endif
