/* A step for real time that may be fed anything.
 *
 * A sample that is not finite, or that overflows between two stages, goes no further: the state of
 * the stages it did not reach is left as it was, the last output is repeated, and a flag is raised
 * that stays up until the caller lowers it. A NaN or an infinity never enters the state. */
#ifndef HYST_GUARD_H
#define HYST_GUARD_H

#include "hyst/chain.h"
#include "hyst/finite.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    hyst_real y_last; /* what a bad sample is answered with; set it to a safe output at start */
    int fault;        /* 0, or 1 since the first bad sample */
} hyst_guard;

hyst_real hyst_guarded_step(const hyst_chain *chain, hyst_real *state, hyst_guard *guard,
                            hyst_real u);

#ifdef HYST_EXTERN_C
}
#endif

#endif
