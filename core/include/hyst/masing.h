/* Hysteresis as a loading curve with memory of reversals (S3 eqs. 2-3).
 *
 * Before the first reversal          y = sign(u) f(|u|)
 * on the branch from (u_i, y_i)      y = y_i + 2 sign(u - u_i) f(|u - u_i| / 2).
 *
 * Nested memory (Masing): reversals are kept on a stack. A branch that reaches the reversal before
 * its own closes a loop; both are forgotten and the outer branch goes on. A branch that reaches the
 * mirror image of the first reversal goes on along the loading curve. The discrete
 * Prandtl-Ishlinskii operator is the case of a piecewise linear f.
 * When the stack is full, further reversals are not kept: the input then goes back along the branch
 * it came by, as if the loop had no area. So every loop, at any depth, still closes, and only the
 * area of loops nested deeper than `depth` is lost; the overflow entry of the state says so.
 *
 * Memory of the last reversal (S3 as published): only the last one is kept. With a dead band, a
 * reversal counts once the input has gone back by more than that; until then it goes back along the
 * branch, and the new branch starts where the dead band ends.
 *
 * There the output never moves against the input, and a reversal that does not move it is none; so
 * the inverse, which sees only the output, knows the same reversals.
 *
 * The inverse exchanges the parts of u and y: y = y_i + 2 sign(..) f^-1(..). The dead band belongs to
 * the input of the operator that is inverted, which is the inverse's output. */
#ifndef HYST_MASING_H
#define HYST_MASING_H

#include "hyst/kind.h"
#include "hyst/loading_curve.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    hyst_loading_curve curve;
    int inverse;         /* 0: y from u, 1: u from y */
    int last_reversal;   /* 0: nested memory, 1: of the last reversal alone */
    size_t depth;        /* reversals the state has room for, >= 1; 1 for the last reversal alone */
    hyst_real dead_band; /* >= 0; 0 for nested memory */
} hyst_masing;

/* Places in the state, all zero at first; then come input and output of every reversal. */
enum {
    HYST_MASING_INPUT,    /* last input; for the last reversal alone, the extreme since then */
    HYST_MASING_OUTPUT,   /* the output that belongs to it */
    HYST_MASING_COUNT,    /* reversals on the stack */
    HYST_MASING_OVERFLOW, /* 1 since a reversal has found the stack full */
    HYST_MASING_STACK
};

size_t hyst_masing_state_length(const hyst_masing *model);

/* Reversals on the stack: never more than it has room for, whatever the state says. */
size_t hyst_masing_reversals(const hyst_masing *model, const hyst_real *state);

hyst_real hyst_masing_step(const hyst_masing *model, hyst_real *state, hyst_real input);

/* f or its inverse, as the model has it. */
hyst_real hyst_masing_curve(const hyst_masing *model, hyst_real x);

extern const hyst_kind hyst_masing_kind; /* of a hyst_masing */

#ifdef HYST_EXTERN_C
}
#endif

#endif
