/* Superposition of dead-zone functions: a piecewise linear map (S1 eq. 49, S4 eq. 29).
 *
 * Two-sided: y = sum_i w_i S(u, rho_i) with
 *   S(u, rho) = max(u - rho, 0) for rho > 0, min(u - rho, 0) for rho < 0, u for rho = 0.
 *
 * By direction: the form printed in S0 eq. 3. Each term depends on the direction of the input:
 *   u_k - rho while u rises and u_k > rho, u_k + rho while u falls and u_k < -rho, else 0.
 * Its state is the previous input, initially 0. */
#ifndef HYST_DEAD_ZONE_H
#define HYST_DEAD_ZONE_H

#include "hyst/kind.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    size_t count;              /* number of terms */
    const hyst_real *weight;   /* w_i */
    const hyst_real *threshold; /* rho_i, in units of u, any order and sign */
} hyst_dead_zone;

hyst_real hyst_dead_zone_step(const hyst_dead_zone *map, hyst_real u);

hyst_real hyst_direction_dead_zone_step(const hyst_dead_zone *map, hyst_real *u_previous,
                                        hyst_real u);

extern const hyst_kind hyst_dead_zone_kind; /* of a hyst_dead_zone */
extern const hyst_kind hyst_direction_dead_zone_kind; /* of a hyst_dead_zone */

#ifdef HYST_EXTERN_C
}
#endif

#endif
