/* Prandtl-Ishlinskii operator (S1 eq. 4):  y = p0 u + sum_i p_i play_{r_i}[u].
 * Its inverse is the same operator with other constants (S1 eqs. 7-8), so one step serves both. */
#ifndef HYST_PRANDTL_ISHLINSKII_H
#define HYST_PRANDTL_ISHLINSKII_H

#include "hyst/kind.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    size_t count;       /* number of plays */
    hyst_real p0;       /* weight of the input itself */
    const hyst_real *p; /* weights of the plays */
    const hyst_real *r; /* their thresholds, >= 0, in units of u */
} hyst_pi;

/* One sample. z holds the count play outputs; hyst/bank.h says in which order they are summed. */
hyst_real hyst_pi_step(const hyst_pi *pi, hyst_real *z, hyst_real u);

extern const hyst_kind hyst_pi_kind; /* of a hyst_pi */

#ifdef HYST_EXTERN_C
}
#endif

#endif
