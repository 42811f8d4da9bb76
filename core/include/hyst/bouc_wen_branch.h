/* Branches of Bouc-Wen's model between two turns, exact for any exponent n > 0.
 *
 * With z as a share of its limit in the direction of the input, and the way times its rate, a branch is
 *
 *     share >= 0   dshare = (1 - share^n) dway                          the loop closes in on its limit
 *     share < 0    dshare = (1 + ratio |share|^n) dway, ratio >= 0      unloading
 *
 * so that the way to a share is a quadrature, with w = share^n and ratio |share|^n
 *
 *     rising    int_0^share dt / (1 - t^n)         = share 2F1(1, 1/n; 1 + 1/n; w)
 *     falling   int_0^|share| dt / (1 + ratio t^n) = |share| 2F1(1, 1/n; 1 + 1/n; -w)
 *
 * by Gauss's continued fraction (Jones and Thron, Continued Fractions, Addison-Wesley 1980, sec. 6.1),
 * whose n-th convergent is off by ((sqrt(1 + w) - 1) / (sqrt(1 + w) + 1))^n, and near the limit, for
 * w > 3/4 and with q = 1 - w, by (-ln q - sum_k c_k q^k / k) / n + join, c_k = prod_j (j - 1/n) / j.
 *
 * Back, from a way to a share, is Newton's method: in -ln(1 - share), in which the way of a rising
 * share is nearly straight, its slope between 1 and 1/n; and downwards from the left of a concave
 * function. At most HYST_BOUC_WEN_STEPS steps, some 3. `tilt`, > -1, adds tilt times the share to the
 * way: what the inverse solves. Its derivative is that of the equation (engine/dual/core.hpp). */
#ifndef HYST_BOUC_WEN_BRANCH_H
#define HYST_BOUC_WEN_BRANCH_H

#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

#define HYST_BOUC_WEN_STEPS 60
/* Of ratio |share|^n: the continued fraction is cut for no more. */
#define HYST_BOUC_WEN_RATIO HYST_REAL(1024.0)

/* What the two forms of the rising way differ by: a constant of n. */
hyst_real hyst_bouc_wen_join(hyst_real n);

/* The way from 0 to a share, 0 <= share < 1, and that to minus a share, 0 <= share. */
hyst_real hyst_bouc_wen_rising(hyst_real n, hyst_real join, hyst_real share);
hyst_real hyst_bouc_wen_falling(hyst_real n, hyst_real ratio, hyst_real share);

/* The share after a way >= 0 from another one, 0 <= from; and, towards 0 and at most as far, |share|. */
hyst_real hyst_bouc_wen_risen(hyst_real n, hyst_real join, hyst_real tilt, hyst_real from,
                              hyst_real way);
hyst_real hyst_bouc_wen_fallen(hyst_real n, hyst_real ratio, hyst_real tilt, hyst_real from,
                               hyst_real way);

#ifdef HYST_EXTERN_C
}
#endif

#endif
