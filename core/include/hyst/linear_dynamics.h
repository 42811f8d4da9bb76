/* Linear time-invariant dynamics of one input and one output, sampled, with a delay of whole
 * samples. Two realizations: a state space, and a cascade of second-order sections.
 *
 *   w_k = u_{k - delay},   y_k = c x_k + d w_k,   x_{k+1} = A x_k + b w_k
 *
 * A state that is not finite is never stored: the step then leaves the state as it was and
 * returns what is not finite, which a guarded step answers with the last good output. */
#ifndef HYST_LINEAR_DYNAMICS_H
#define HYST_LINEAR_DYNAMICS_H

#include "hyst/kind.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

/* The next state of a state space is formed in a local array of this length. */
#define HYST_LARGEST_ORDER 64

typedef struct {
    size_t order;       /* n <= HYST_LARGEST_ORDER */
    size_t delay;       /* whole samples */
    const hyst_real *a; /* n x n, column after column */
    const hyst_real *b; /* n */
    const hyst_real *c; /* n */
    hyst_real d;
} hyst_state_space;

/* A section is (b0 + b1 q^-1 + b2 q^-2) / (1 + a1 q^-1 + a2 q^-2). */
typedef struct {
    size_t count;                 /* number of sections */
    const hyst_real *coefficient; /* count x 5: b0 b1 b2 a1 a2 */
} hyst_sections;

/* One sample. state: x_1 .. x_n, then the delay line, oldest first. */
hyst_real hyst_state_space_step(const hyst_state_space *system, hyst_real *state, hyst_real u);

/* One sample through all sections, each in transposed direct form II. state: two for each. */
hyst_real hyst_sections_step(const hyst_sections *sections, hyst_real *state, hyst_real u);

extern const hyst_kind hyst_state_space_kind; /* of a hyst_state_space */
extern const hyst_kind hyst_sections_kind; /* of a hyst_sections */

#ifdef HYST_EXTERN_C
}
#endif

#endif
