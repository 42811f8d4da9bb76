/* The hysteresis of Jiles and Atherton, and its inverse.
 *
 *     He = H + alpha M,   Man = Ms L(He / a),   L(x) = coth x - 1/x,   s = sgn(dH)
 *
 * In units of Ms and a, with x = He / a, eta = alpha Ms / a, kappa = a / k, m = M / Ms and the distance
 * Y = L(x) - m, every variant is an equation over the effective field x:
 *
 *     effective field          Y' = (1 - c) L' - s kappa Y
 *     Jiles, Thoelke, Devine   X' = L' - s kappa X (1 - eta c L') / (1 - s eta kappa c X),  Y = (1 - c) X
 *     Jiles, Atherton          Y' = L' - (s kappa Y + c L' (1 - s eta kappa Y)) / (1 + c - s eta kappa c Y)
 *
 * where s Y > 0; where s Y <= 0, after a turn, the pinned part rests (delta_M = 0) and m follows
 * r L(x), r = c in the first two and c / (1 + c) in the third. See src/hyst/models/jiles_atherton.py for
 * the equations as they are published, and their sources.
 *
 * So a branch has two stretches: a closed form up to the place x0 where Y = 0, L(x0) known, and from
 * there sub-steps of order 8 (hyst_branch_advance) between nodes at x0 + s j width; beyond `reach` the
 * relaxation in closed form, with the slow part as a series in 1 / (kappa x). H = a (x - eta m) grows
 * with x as long as eta / 3 < 1; so for a sample, the node before it is found and then x, by Newton's
 * method between two nodes. The output depends on the turn and on H alone: samples in between change no
 * bit. Sub-steps: at most 2 reach / width on a branch.
 *
 * The inverse solves the same for the output, which grows with x as well.
 *
 * Losses that follow the rate of the output v (G. Bertotti, Hysteresis in Magnetism, Academic Press
 * 1998, ch. 12) lower the field within, a (x - eta m) = H - k_cl dv/dt - k_ex sgn(dv/dt) |dv/dt|^(1/2).
 * The rate is (v_k - v_{k-1}) / dt, so that the classical part is linear in v and adds to what is
 * sought, and so does a root for the excess; all of it still grows with x. Whether a branch turns is
 * told by the field within.
 *
 * State: HYST_JILES_LENGTH numbers, all zero in the demagnetised state. */
#ifndef HYST_JILES_ATHERTON_H
#define HYST_JILES_ATHERTON_H

#include "hyst/kind.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

/* Steps of Newton's method and of halving at most; three to five are usual. */
#define HYST_JILES_LIMIT 100u

enum {
    HYST_JILES_INPUT,  /* the last one; with losses the field within */
    HYST_JILES_SIGN,   /* of the branch; 0 before the first */
    HYST_JILES_X,      /* He / a of the last sample */
    HYST_JILES_M,      /* M / Ms of the last sample */
    HYST_JILES_X_TURN, /* where the branch began */
    HYST_JILES_REST,   /* m - r L(x) on its first stretch */
    HYST_JILES_X_NODE, /* the last node, at first where the second stretch begins */
    HYST_JILES_Y_NODE, /* Y there */
    HYST_JILES_LENGTH
};

typedef enum { HYST_JILES_EFFECTIVE_FIELD, HYST_JILES_1992, HYST_JILES_1986 } hyst_jiles_variant;

typedef struct {
    hyst_jiles_variant variant;
    hyst_real eta;     /* alpha Ms / a, 0 to less than 3 */
    hyst_real kappa;   /* a / k, > 0 */
    hyst_real c;       /* 0 to less than 1 */
    hyst_real field;   /* a: H = field (x - eta m) */
    hyst_real level;   /* the output is level (x_share x + m_share m) */
    hyst_real x_share; /* 0 for M, 1 for B */
    hyst_real m_share;
    hyst_real width;   /* of a sub-step, in x */
    hyst_real reach;   /* of sub-steps, in x */
    int loses;         /* whether there are losses, be they 0 */
    hyst_real eddy;    /* k_cl level / (dt a), 0 without */
    hyst_real excess;  /* k_ex (level / dt)^(1/2) / a, 0 without */
    int inverse;       /* whether the input is the output */
} hyst_jiles_atherton;

/* A stretch of a branch. */
typedef struct {
    const hyst_jiles_atherton *model;
    int rests; /* whether it is the first one */
    hyst_real sign;
    hyst_real rest;
    hyst_real x_node;
    hyst_real y_node;
    hyst_real by_x; /* sought: by_x x + by_m m */
    hyst_real by_m;
    hyst_real excess; /* and excess times the root of how far the output is from the last one */
    hyst_real last;   /* which is this, over the level */
    hyst_real x_last; /* and was at */
} hyst_jiles_stretch;

/* m at x. */
hyst_real hyst_jiles_m(const hyst_jiles_stretch *on, hyst_real x);

/* What is sought, at x, and its slope there. */
hyst_real hyst_jiles_sought(const hyst_jiles_stretch *on, hyst_real x, hyst_real *slope);

/* The x between two, at which it is known, where what is sought is the target; one of the two if it lies
 * beyond. */
hyst_real hyst_jiles_root(const hyst_jiles_stretch *on, hyst_real target, hyst_real low,
                          hyst_real at_low, hyst_real high, hyst_real at_high);

/* One sample. The inverse answers a magnetisation of Ms or more, which no field reaches, by what is not
 * finite, and keeps its state. */
hyst_real hyst_jiles_atherton_step(const hyst_jiles_atherton *model, hyst_real *state,
                                   hyst_real input);

extern const hyst_kind hyst_jiles_atherton_kind;

#ifdef HYST_EXTERN_C
}
#endif

#endif
