/* Composition: stages in the order the signal passes them, first to last.
 *
 * The state of a chain is one flat array: the states of its stages, one after the other.
 * A generalized Prandtl-Ishlinskii model (S1 sec. 2.1) is the chain dead zone, PI; a modified one
 * (S4 sec. III-D) is the chain PI, dead zone; their inverses are the inverse stages reversed. */
#ifndef HYST_CHAIN_H
#define HYST_CHAIN_H

#include "hyst/dead_zone.h"
#include "hyst/linear_dynamics.h"
#include "hyst/masing.h"
#include "hyst/memory_element.h"
#include "hyst/prandtl_ishlinskii.h"
#include "hyst/rate_dependent_prandtl_ishlinskii.h"
#include "hyst/real.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    hyst_real gain;
    hyst_real offset;
} hyst_affine; /* y = gain u + offset */

typedef enum {
    HYST_AFFINE,
    HYST_PLAY,
    HYST_STOP,
    HYST_DEAD_ZONE,
    HYST_DIRECTION_DEAD_ZONE,
    HYST_PI,
    HYST_RATE_DEPENDENT_PI,
    HYST_STATE_SPACE,
    HYST_SECTIONS,
    HYST_MASING,
    HYST_MEMORY_ELEMENT
} hyst_kind;

typedef struct {
    hyst_kind kind; /* which member of the union is meant */
    union {
        hyst_affine affine;
        hyst_real r; /* threshold of a play or a stop */
        hyst_dead_zone dead_zone;
        hyst_pi pi;
        hyst_rate_dependent_pi rate_dependent_pi;
        hyst_state_space state_space;
        hyst_sections sections;
        hyst_masing masing;
        hyst_memory_element memory_element;
    } as;
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

#ifdef __cplusplus
}
#endif

#endif
