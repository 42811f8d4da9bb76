/* Plays whose outputs creep, each with weights of its own, and the exact inverse.
 *
 *     y_k = p0 u_k + sum_i p_i z_i,k + sum_ij w_ij x_ij,k,   x_ij,k+1 = x_ij,k + g_j (z_i,k - x_ij,k)
 *
 * z_i are plays of u. What the lags answer belongs to the samples before, so the inverse is that of the
 * plays, of what the lags leave of y; then the plays and the lags follow the command that it gave.
 *
 * State: z; of the inverse the plays of its bank; then for every play and every lag x and what rounding
 * left of its step, as in hyst/creep.h. */
#ifndef HYST_CREEPING_PLAYS_H
#define HYST_CREEPING_PLAYS_H

#include "hyst/creep.h"
#include "hyst/kind.h"
#include "hyst/prandtl_ishlinskii.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    hyst_pi plays;
    hyst_pi back;            /* the inverse bank; of no plays where the input is u */
    size_t lags;             /* m */
    const hyst_real *weight; /* w, play after play, n x m */
    const hyst_real *gain;   /* g, m, between 0 and 1 */
    int inverse;             /* whether the input is y */
} hyst_creeping_plays;

/* One sample. What is not finite, or would make the state so, is answered and the state kept. */
hyst_real hyst_creeping_plays_step(const hyst_creeping_plays *model, hyst_real *state,
                                   hyst_real input);

extern const hyst_kind hyst_creeping_plays_kind; /* of a hyst_creeping_plays */

#ifdef HYST_EXTERN_C
}
#endif

#endif
