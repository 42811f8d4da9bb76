/* The Preisach operator on a grid of cells, and its inverse.
 *
 *     y = p0 u + sum over relays (alpha, beta), beta <= alpha, of their mass times +1 (up) or -1 (down)
 *
 * A relay goes up where the input rises to alpha, down where it falls to beta. F. Preisach, Z. Phys. 94
 * (1935) 277; D. H. Everett, Trans. Faraday Soc. 51 (1955) 1551; I. D. Mayergoyz, Mathematical Models of
 * Hysteresis (Springer 1991), eqs. 1.2, 2.41.
 *
 * Thresholds t_0 < .. < t_n cut the half plane into cells; each has a mass, spread evenly over it (over
 * the triangle on the diagonal), or along the line from its corner (t_i, t_j) to (t_i+1, t_j+1), which
 * makes it a Krasnoselskii-Pokrovskii hysteron with ridges as wide as the cell. Between two reversals
 *
 *     y = y_s + p0 (u - u_s) +- 2 F(alpha, beta),
 *
 * F the mass of the relays between the start of the branch and the input. F at the corners of cells is
 * a table. In between, y as a function of u is, from threshold to threshold, a straight line and a
 * square (the triangle that the input crosses): no staircase, and an inverse in closed form.
 *
 * Reversals are kept on a stack, as in hyst/masing.h, with its policy when the stack is full: loops
 * nested deeper are traced without area and still close, and the overflow entry of the state says so.
 * Below the first reversal lies the demagnetised state, in which relays with alpha + beta < 0 are up; the
 * first loading curve from there is a table too, y_v(u). A branch that comes to the mirror image of the first
 * reversal, -u_1, goes on along it.
 *
 * Operations of a sample, n cells a side: the output takes two searches of a cell (one look at an
 * evenly spaced grid, else log2 n + 1 comparisons), 4 entries of the table and 2 divisions; with a first
 * reversal alone one look at the first loading curve more. The inverse takes at most log2 n + 2 entries
 * of the branch, 2 entries of the table each, and one root. Wiping out is one comparison for each
 * reversal that is forgotten. */
#ifndef HYST_PREISACH_H
#define HYST_PREISACH_H

#include "hyst/kind.h"
#include "hyst/power.h"
#include "hyst/real.h"
#include "hyst/root.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    size_t cells;               /* n, along a side */
    const hyst_real *threshold; /* n + 1, ascending */
    hyst_real per_input;        /* n / (t_n - t_0) */
    /* Twice the mass of relays with alpha <= t_i and beta >= t_j, j <= i, at i (i + 1) / 2 + j. */
    const hyst_real *everett;
    /* The first loading curve up and down without p0, a row for each knot: |u|, y, and what the straight
     * line and the square add up to the next knot, both >= 0. The first knot is 0. */
    size_t rising_knots;
    const hyst_real *rising;
    size_t falling_knots;
    const hyst_real *falling;
    hyst_real p0;
    int ridges;   /* mass along the lines of the cells, not all over them */
    int inverse;  /* 0: y from u, 1: u from y */
    size_t depth; /* reversals the state has room for, >= 1 */
} hyst_preisach;

/* Places in the state; then come u and y of every reversal. A forward operator starts with all zero but
 * the input, which may be any the demagnetised state was left to; its inverse with y and u of it. */
enum {
    HYST_PREISACH_INPUT,    /* last input */
    HYST_PREISACH_OUTPUT,   /* the output that belongs to it; of the forward operator once there is one */
    HYST_PREISACH_COUNT,    /* reversals on the stack */
    HYST_PREISACH_OVERFLOW, /* 1 since a reversal has found the stack full */
    HYST_PREISACH_STACK
};

typedef struct {
    hyst_real u, y;
} hyst_preisach_point;

/* A part of a branch between two thresholds: with e = (u - from.u) / width
 *     y = from.y +- e (line + square e),   no further than to `to`. */
typedef struct {
    hyst_preisach_point from, to;
    hyst_real width; /* of the sign of the way */
    hyst_real line, square;
    int rising, has_end;
} hyst_preisach_piece;

/* The piece of the branch from `start`, or of the first loading curve where start is NULL, that leads to
 * an input, or to an output. */
hyst_preisach_piece hyst_preisach_to_input(const hyst_preisach *model, const hyst_preisach_point *start,
                                           hyst_real u);
hyst_preisach_piece hyst_preisach_to_output(const hyst_preisach *model, const hyst_preisach_point *start,
                                            hyst_real y);

/* Reversals on the stack: never more than it has room for, whatever the state says. */
size_t hyst_preisach_reversals(const hyst_preisach *model, const hyst_real *state);

/* One sample. The inverse answers an output beyond saturation, where p0 is 0, by what is not finite,
 * and keeps its state. */
hyst_real hyst_preisach_step(const hyst_preisach *model, hyst_real *state, hyst_real input);

extern const hyst_kind hyst_preisach_kind;

static inline int hyst_preisach_is_past(int rising, hyst_real value, hyst_real limit)
{
    return rising ? value > limit : value < limit;
}

/* y on a piece at u. */
static inline hyst_real hyst_preisach_output(const hyst_preisach_piece *piece, hyst_real u)
{
    const hyst_real e = (u - piece->from.u) / piece->width;
    const hyst_real rise = e * (piece->line + piece->square * e);
    const hyst_real y = piece->rising ? piece->from.y + rise : piece->from.y - rise;
    return piece->has_end && hyst_preisach_is_past(piece->rising, y, piece->to.y)
               ? HYST_ROUNDED(y, piece->to.y)
               : y;
}

/* The part e of a piece whose rise is the part d of the whole: l e + s e^2 = d, l + s = 1. Parts below
 * 1e-30 move the input by less than rounding. */
static inline hyst_real hyst_preisach_part(hyst_real l, hyst_real s, hyst_real d)
{
    if (!(s > HYST_REAL(0.0))) {
        return d;
    }
    if (!(d > HYST_REAL(1e-30))) {
        return l > HYST_REAL(0.0) ? d / l : HYST_REAL(0.0);
    }
    return HYST_REAL(2.0) * d / (l + hyst_root(l * l + HYST_REAL(4.0) * s * d));
}

/* Whether an output lies beyond a rest: an eighth of the way shows, more than sums of another order leave. */
static inline int hyst_preisach_is_beyond(hyst_real rest, hyst_real way)
{
    const hyst_real moved = rest + HYST_REAL(0.125) * way;
    return way > HYST_REAL(0.0) && (moved > rest || moved < rest);
}

/* u on a piece at y; an infinity, 2 to the power 1e6, where no input reaches that output. */
static inline hyst_real hyst_preisach_input(const hyst_preisach_piece *piece, hyst_real y)
{
    const hyst_real way = piece->rising ? y - piece->from.y : piece->from.y - y;
    const hyst_real rise = piece->line + piece->square;
    if (!(rise > HYST_REAL(0.0))) {
        return hyst_preisach_is_beyond(piece->from.y, way) ? hyst_exp2(HYST_REAL(1e6)) : piece->from.u;
    }
    const hyst_real e = hyst_preisach_part(piece->line / rise, piece->square / rise, way / rise);
    const hyst_real u = piece->from.u + e * piece->width;
    return piece->has_end && hyst_preisach_is_past(piece->rising, u, piece->to.u)
               ? HYST_ROUNDED(u, piece->to.u)
               : u;
}

#ifdef HYST_EXTERN_C
}
#endif

#endif
