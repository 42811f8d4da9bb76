/* Branches of rate-independent models dz = f(z, u, sign du) du.
 *
 * Between two turns of the input such a model runs along one branch, the solution of an equation
 * dz/du = f(z, u, s) with s = 1 or -1 from where the branch began, at the last turn. Branches are
 * counted from there, not added up from sample to sample: then samples in between change no bit, and
 * ways that are small beside the digits of u and z add up.
 *
 * A model with a closed form keeps four numbers (HYST_BRANCH_LENGTH): u and z of the last sample, and
 * both where the branch began; hyst_branch_turns says whether a sample begins another. dahl.c is one.
 *
 * A model without a closed form gives its slope f and a width, keeps HYST_BRANCH_NODES_LENGTH numbers
 * (all u of them the input before the first sample, all z its z, the node 0), and calls
 *
 *     z = hyst_branch_step(&equation, state, u);
 *
 * It passes nodes at u_turn + s j width, j = 1, 2, .., by the method of order 8 of
 *
 *     G. J. Cooper and J. H. Verner, Some explicit Runge-Kutta methods of high order, SIAM J. Numer.
 *     Anal. 9 (1972) 389-405 (11 slopes a step; its conditions of order were checked numerically),
 *
 * and from the last of them goes on to u. z depends on the turn and on u alone, since the nodes do;
 * the state keeps the last node and its z, so that a sample costs 11 slopes and 11 more for each node
 * it passes.
 *
 * Accuracy: with L the largest |df/dz|, and f no quicker in u, a width of 1 / (8 L) leaves less than
 * 1e-12 of z's range on a branch, 1 / (4 L) 2e-10 and 1 / (2 L) 6e-8, in single precision a few
 * roundings (core/tests/test_branch.c: an exponential, a tanh and a driven equation). Where f has a
 * kink, as |z| has at 0, a step across it is of first or second order: such a model needs a form of its
 * own there.
 *
 * A sample passes at most HYST_BRANCH_MOST nodes. A longer way leaves out those before the last
 * HYST_BRANCH_MOST: the models that belong here forget, z by exp(-L |du|), and what is left out would
 * have been forgotten. So a width must be no less than some 1 / (20 L), or a model that does not forget
 * must refuse such inputs itself. Samples in between then change the last digits.
 *
 * A rest, du = 0, changes nothing. What is not finite, be it a way or z, is answered and the state kept.
 *
 * Single precision: nodes are counted as a number, exactly to 2^24. Derivatives: the kernel's own (no
 * iteration is in here); the width may depend on constants. */
#ifndef HYST_BRANCH_H
#define HYST_BRANCH_H

#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

/* Places in the state. */
#define HYST_BRANCH_U 0u
#define HYST_BRANCH_Z 1u
#define HYST_BRANCH_U_TURN 2u
#define HYST_BRANCH_Z_TURN 3u
#define HYST_BRANCH_LENGTH 4u
#define HYST_BRANCH_NODE 4u
#define HYST_BRANCH_Z_NODE 5u
#define HYST_BRANCH_NODES_LENGTH 6u

#define HYST_BRANCH_MOST 1024u

/* Whether an input ends the branch that began at one and came to another: it turns. */
int hyst_branch_turns(hyst_real began, hyst_real last, hyst_real input);

typedef struct {
    const void *model;
    hyst_real (*slope)(const void *model, hyst_real u, hyst_real z, hyst_real sign); /* dz/du */
    hyst_real width;                                                                 /* > 0 */
} hyst_branch_equation;

/* z after a way of h towards sign, from u and z: one step, for models that place their own nodes. */
hyst_real hyst_branch_advance(const hyst_branch_equation *equation, hyst_real u, hyst_real z,
                              hyst_real sign, hyst_real h);

/* z at u, which ends up in the state. */
hyst_real hyst_branch_step(const hyst_branch_equation *equation, hyst_real *state, hyst_real u);

#ifdef HYST_EXTERN_C
}
#endif

#endif
