/* The LuGre model of friction: bristles that bend, and slide at the force of the Stribeck curve.
 *
 *     dz/dt = v - sigma0 |v| z / s(v),   F = sigma0 z + sigma1 dz/dt + sigma2 v + Fv tanh(v / vv)
 *
 * C. Canudas de Wit, H. Olsson, K. J. Astrom and P. Lischinsky, A new model for control of systems with
 * friction, IEEE Trans. Automatic Control 40 (1995) 419-425, eqs. 3-5, whose viscous force is any function
 * of v; one that saturates is that of fluids which thin as they are sheared.
 *
 * The velocity is constant from sample to sample, v = (u_k - u_{k-1}) / dt, so with w = sigma0 z and
 * x = sigma0 |u_k - u_{k-1}| / s(v) a sample is exact:
 *
 *     w_k = w_{k-1} + (s(v) sgn v - w_{k-1}) (1 - exp(-x))
 *
 * The force is that at the end of the sample, at u_k, while its velocity still lasts.
 *
 * State: position of the last sample, force w, what rounding has left out of it, and 1 once there is a
 * last sample (0 before the first one, whose velocity is 0). */
#ifndef HYST_LUGRE_H
#define HYST_LUGRE_H

#include "hyst/kind.h"
#include "hyst/real.h"
#include "hyst/stribeck.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    hyst_real stiffness; /* sigma0 > 0, of the bristles */
    hyst_real damping;   /* sigma1 >= 0, of the bristles */
    hyst_real viscosity; /* sigma2 >= 0 */
    hyst_real thinning;  /* Fv >= 0, what thinning viscosity ends at */
    hyst_real thin;      /* 1 / vv > 0 */
    hyst_stribeck curve; /* with delta = 2 */
    hyst_real rate; /* 1 / dt */
} hyst_lugre;

/* One sample. A force beyond every number is answered by what is not finite, the state unchanged. */
hyst_real hyst_lugre_step(const hyst_lugre *model, hyst_real *state, hyst_real u);

extern const hyst_kind hyst_lugre_kind;

#ifdef HYST_EXTERN_C
}
#endif

#endif
