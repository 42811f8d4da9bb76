/* The hysteresis of Coleman and Hodgdon, and its inverse.
 *
 *     dy/du = alpha s (f(u) - y) + g(u),   s = sgn(du),   alpha > 0
 *
 * B. D. Coleman and M. L. Hodgdon, A constitutive relation for rate-independent hysteresis in
 * ferromagnetically soft materials, Int. J. Engng Sci. 24 (1986) 897-919, eq. 1.4; On a class of
 * constitutive relations for ferromagnetic hysteresis, Arch. Rational Mech. Anal. 99 (1987) 375-396.
 *
 * f is odd and of linear pieces, f' = a_j where knot_j <= |u| < knot_{j+1}, knot_0 = 0, and g = b_j is
 * even and constant on them. Within a piece the distance D = y - f relaxes towards -s (a_j - b_j) / alpha:
 *
 *     D' = D + (D_inf - D) (1 - exp(-alpha |du|)),
 *
 * so a sample costs an exponential for every piece between the last turn and u. The way is taken from
 * the turn: samples in between change no bit.
 *
 * Back, a sample solves A x + q (1 - exp(-x)) = w in one of the pieces, by Newton's method from the
 * side from which it comes closer with every step (hyst_coleman_way).
 *
 * State: input u and output y of the last sample, and both where the branch began. */
#ifndef HYST_COLEMAN_HODGDON_H
#define HYST_COLEMAN_HODGDON_H

#include "hyst/kind.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

/* Steps of Newton's method at most; five are usual. */
#define HYST_COLEMAN_LIMIT 64u

typedef struct {
    hyst_real alpha;       /* per input unit */
    size_t count;          /* >= 1 pieces on each side of 0 */
    const hyst_real *a;    /* slope of f; for the inverse > 0 */
    const hyst_real *b;    /* g */
    const hyst_real *knot; /* count - 1 of them, > 0, ascending */
    int inverse;           /* whether the input is y */
} hyst_coleman_hodgdon;

/* One sample. */
hyst_real hyst_coleman_hodgdon_step(const hyst_coleman_hodgdon *model, hyst_real *state,
                                    hyst_real input);

/* 1 - exp(-x) for x >= 0, with all digits. */
hyst_real hyst_coleman_share(hyst_real x);

/* The x >= 0 with line x + bend (1 - exp(-x)) = w, for w >= 0, line > 0 and line + bend > 0. */
hyst_real hyst_coleman_way(hyst_real line, hyst_real bend, hyst_real w);

extern const hyst_kind hyst_coleman_hodgdon_kind;

#ifdef HYST_EXTERN_C
}
#endif

#endif
