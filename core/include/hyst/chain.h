/* Composition: stages in the order the signal passes them, first to last.
 *
 * The state of a chain is one flat array: the states of its stages, one after the other.
 * A generalized Prandtl-Ishlinskii model (S1 sec. 2.1) is the chain dead zone, PI; a modified one
 * (S4 sec. III-D) is the chain PI, dead zone; their inverses are the inverse stages reversed. */
#ifndef HYST_CHAIN_H
#define HYST_CHAIN_H

#include "hyst/kind.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    const hyst_kind *kind; /* as &hyst_pi_kind */
    const void *model;     /* the structure of that kind, as a hyst_pi */
} hyst_stage;

typedef struct {
    size_t count;
    const hyst_stage *stage;
} hyst_chain;

/* Number of state values of one stage, and of the whole chain. */
size_t hyst_stage_state_length(const hyst_stage *stage);
size_t hyst_chain_state_length(const hyst_chain *chain);

/* One sample through one stage, and through the whole chain. The input must be finite;
 * see guard.h for a step that may be fed anything. */
hyst_real hyst_stage_step(const hyst_stage *stage, hyst_real *state, hyst_real u);
hyst_real hyst_chain_step(const hyst_chain *chain, hyst_real *state, hyst_real u);

/* A record: y may be u itself. The state is carried from call to call. */
void hyst_stage_run(const hyst_stage *stage, hyst_real *state, const hyst_real *u, hyst_real *y,
                    size_t samples);
void hyst_chain_run(const hyst_chain *chain, hyst_real *state, const hyst_real *u, hyst_real *y,
                    size_t samples);

#ifdef HYST_EXTERN_C
}
#endif

#endif
