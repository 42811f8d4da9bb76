/* A repetitive controller: memory of a period, then the inverse of the hysteresis.
 *
 *   v_k = y_ref,k + w_k as in repetitive_memory.h,   u_k = inverse(v_k)
 *
 * State: that of the memory, then that of the inverse, as the chain or the limited inverse has it. */
#ifndef HYST_REPETITIVE_CONTROLLER_H
#define HYST_REPETITIVE_CONTROLLER_H

#include "hyst/chain.h"
#include "hyst/guard.h"
#include "hyst/limited_inverse.h"
#include "hyst/real.h"
#include "hyst/repetitive_memory.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

/* One sample of anything: see guard.h. If y_ref or y is not finite, the last drive is repeated and the
 * inverse stays as it was; the memory goes on to the next sample. *changed: as in
 * repetitive_memory.h. *v becomes the v wanted, where there is one. */
hyst_real hyst_repetitive_step(const hyst_repetitive_memory *memory, const hyst_chain *inverse,
                               hyst_real *state, hyst_guard *guard, hyst_real y_ref, hyst_real y,
                               hyst_real *v, int *changed);

/* The same with a drive that is limited; *v becomes the v that belongs to the drive applied.
 * before: as in limited_inverse.h. */
hyst_real hyst_limited_repetitive_step(const hyst_repetitive_memory *memory,
                                       const hyst_limited_inverse *inverse, hyst_real *state,
                                       hyst_real *before, hyst_limited_guard *guard, hyst_real y_ref,
                                       hyst_real y, hyst_real *v, int *changed);

#ifdef HYST_EXTERN_C
}
#endif

#endif
