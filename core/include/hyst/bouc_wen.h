/* Bouc-Wen's model, and its inverse.
 *
 *     y = k u + h z,   h = 1 or -1
 *     dz = (A - |z|^n (beta sgn(z du) + gamma + phi (sgn(du) + sgn(z)))) du
 *
 * R. Bouc, Modele mathematique d'hysteresis, Acustica 24 (1971) 16-25; Y.-K. Wen, Method for random
 * vibration of hysteretic systems, J. Eng. Mech. Div. ASCE 102 (1976) 249-263, eq. 2. The asymmetric
 * term phi: C.-H. Wang and Y.-K. Wen (1998), as J. Song and A. Der Kiureghian, Generalized Bouc-Wen
 * model for highly asymmetric hysteresis, J. Eng. Mech. 132 (2006) 610-618 give it.
 *
 * z is kept between its limits (A / (beta + gamma + 2 phi))^(1/n) above and
 * -(A / (beta + gamma - 2 phi))^(1/n) below. Branches are exact: see bouc_wen_branch.h, branch.h.
 *
 * State: u and z of the last sample, and both where the branch began; of the inverse also y of the last
 * sample and where the branch began. */
#ifndef HYST_BOUC_WEN_H
#define HYST_BOUC_WEN_H

#include "hyst/kind.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

/* One direction of the input. */
typedef struct {
    hyst_real limit; /* of |z| */
    hyst_real rate;  /* A / limit, per input unit */
    hyst_real ratio; /* (beta - gamma) / (beta + gamma +- 2 phi) >= 0 */
} hyst_bouc_wen_side;

typedef struct {
    hyst_real stiffness; /* k; > 0 for the inverse */
    hyst_real share;     /* h */
    hyst_real exponent;  /* n */
    hyst_real join;      /* hyst_bouc_wen_join(n) */
    hyst_bouc_wen_side up, down;
    int inverse; /* whether the input is y */
} hyst_bouc_wen;

/* One sample. The inverse asks that y rises with u: k + h dz/du > 0 for every z between its limits. */
hyst_real hyst_bouc_wen_step(const hyst_bouc_wen *model, hyst_real *state, hyst_real input);

extern const hyst_kind hyst_bouc_wen_kind;

#ifdef HYST_EXTERN_C
}
#endif

#endif
