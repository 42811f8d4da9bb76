/* Inverses that keep the memory of the model they invert: each sample solves y = f(u, memory) for u with
 * the constants of now, and then moves the memory as f does. So they stay exact while constants move,
 * which the inverse with constants and a memory of its own (S1 eqs. 7-8) does not.
 *
 * f is piecewise linear in u. The search goes from piece to piece by Newton's step, and by the next piece
 * where that leads out of what is known to hold the solution; it ends, for every step leaves at least one
 * end of a piece behind. u is then solved for on its piece alone. Where f does not rise (or for a map,
 * fall) everywhere, there is no answer; the caller sees to it beforehand. */
#ifndef HYST_SOLVED_H
#define HYST_SOLVED_H

#include "hyst/affine.h"
#include "hyst/dead_zone.h"
#include "hyst/prandtl_ishlinskii.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

/* u with y = hyst_pi_step(pi, z, u), which moves z as that step would. */
hyst_real hyst_pi_solved_step(const hyst_pi *pi, hyst_real *z, hyst_real y);

/* u with y = hyst_dead_zone_step(map, u). */
hyst_real hyst_dead_zone_solved_step(const hyst_dead_zone *map, hyst_real y);

/* u with y = gain u + offset. */
hyst_real hyst_affine_solved_step(const hyst_affine *map, hyst_real y);

extern const hyst_kind hyst_pi_solved_kind;        /* of a hyst_pi */
extern const hyst_kind hyst_dead_zone_solved_kind; /* of a hyst_dead_zone */
extern const hyst_kind hyst_affine_solved_kind;    /* of a hyst_affine */

#ifdef HYST_EXTERN_C
}
#endif

#endif
