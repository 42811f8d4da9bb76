/* Bouc-Wen's model whose strength and stiffness degrade and whose loops pinch, and its inverse.
 *
 *     y = k u + z,   e = integral of z du
 *     dz = h(z, e) (A - nu |z|^n (beta sgn(z du) + gamma)) / eta du
 *
 * Sources, and what h, nu and eta are: degrading_branch.h. Branches are counted from their turn, from
 * node to node; a sample that passes more than HYST_DEGRADING_MOST nodes is answered by what is not
 * finite, since energy does not forget.
 *
 * State: u, z over its first limit, and energy over limit^2 / A, of the last sample; u where the branch
 * began; way, z and energy of the last node; of the inverse also y of the last sample and where the
 * branch began. */
#ifndef HYST_DEGRADING_BOUC_WEN_H
#define HYST_DEGRADING_BOUC_WEN_H

#include "hyst/degrading_branch.h"
#include "hyst/kind.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

#define HYST_DEGRADING_MOST 65536u

typedef struct {
    hyst_real stiffness; /* k; > 0 for the inverse */
    hyst_real limit;     /* (A / (beta + gamma))^(1/n), of |z| when new */
    hyst_real rate;      /* A / limit, per input unit */
    hyst_degrading loop;
    int inverse; /* whether the input is y */
} hyst_degrading_bouc_wen;

/* One sample. The inverse asks that y rises with u wherever z may be. */
hyst_real hyst_degrading_bouc_wen_step(const hyst_degrading_bouc_wen *model, hyst_real *state,
                                       hyst_real input);

extern const hyst_kind hyst_degrading_bouc_wen_kind;

#ifdef HYST_EXTERN_C
}
#endif

#endif
