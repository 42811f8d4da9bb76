/* Branches of Bouc-Wen's model that degrades and pinches, between two turns of the input.
 *
 * With z as a share v of what limited it when new, in the direction of the input, the way in units of
 * limit / A and the energy e, the integral of z over the input, in limit^2 / A, a branch is
 *
 *     dv = h(v, e) (1 - nu v^n) / eta dway            v >= 0
 *     dv = h(v, e) (1 + nu ratio |v|^n) / eta dway    v < 0
 *     de = v dway
 *     nu = 1 + delta_nu e,   eta = 1 + delta_eta e
 *     h = 1 - zeta1 exp(-((v - q nu^(-1/n)) / zeta2)^2)
 *     zeta1 = zeta (1 - exp(-p e)),   zeta2 = (psi + delta_psi e) (lambda + zeta1)
 *
 * T. T. Baber and Y.-K. Wen, Random vibration of hysteretic degrading systems, J. Eng. Mech. Div. ASCE
 * 107 (1981) 1069-1087; T. T. Baber and M. N. Noori, Modeling general hysteresis behavior and random
 * vibration application, J. Vib. Acoust. 108 (1986) 411-420; G. C. Foliente, Hysteresis modeling of wood
 * joints and structural systems, J. Struct. Eng. 121 (1995) 1013-1022, eqs. 5-16.
 *
 * It is followed from node to node by the method of order 8 that branch.h names. Widths depend on the
 * node alone, an eighth over how quickly anything changes there, and are halved and doubled next to
 * v = 0, where |v|^n has a kink and the branch has a node. */
#ifndef HYST_DEGRADING_BRANCH_H
#define HYST_DEGRADING_BRANCH_H

#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    hyst_real exponent;  /* n >= 1 */
    hyst_real ratio;     /* (beta - gamma) / (beta + gamma) >= 0 */
    hyst_real delta_nu;  /* >= 0 */
    hyst_real delta_eta; /* >= 0 */
    hyst_real zeta;      /* 0 to less than 1: 0 does not pinch */
    hyst_real p;         /* >= 0 */
    hyst_real q;         /* >= 0 */
    hyst_real psi;       /* > 0 */
    hyst_real delta_psi; /* >= 0 */
    hyst_real lambda;    /* > 0 */
} hyst_degrading;

typedef struct {
    hyst_real share, energy;
} hyst_degrading_point;

/* What both change by with the way. */
hyst_degrading_point hyst_degrading_slope(const hyst_degrading *model, hyst_degrading_point at);

/* Both after a way of one step. */
hyst_degrading_point hyst_degrading_advance(const hyst_degrading *model, hyst_degrading_point at,
                                            hyst_real way);

/* The way to the next node, and both there. */
hyst_real hyst_degrading_next(const hyst_degrading *model, hyst_degrading_point at,
                              hyst_degrading_point *next);

/* The way of at most so far at which by_way times the way, and the share, are the target. */
hyst_real hyst_degrading_root(const hyst_degrading *model, hyst_degrading_point at,
                              hyst_real by_way, hyst_real target, hyst_real far);

#ifdef HYST_EXTERN_C
}
#endif

#endif
