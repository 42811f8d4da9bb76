/* A bank of plays, the last stage of an inverse, in front of an actuator whose drive is limited.
 *
 *   u = bank(v);   where u may not be: u_a, the nearest that may, and v_a with bank(v_a) = u_a
 *
 * The answers of limited_inverse.h without the memory of the model in front: where the drive is held, the
 * plays are moved from where they were to where v_a takes them, so that their memory is that of an
 * actuator driven by u_a. What is before the bank has no memory and is not asked again.
 *
 * The bank rises as far as any plays move, narrowest first, as that of every exact inverse does.
 *
 * State: the plays, the last drive (within the limits at start). */
#ifndef HYST_LIMITED_BANK_H
#define HYST_LIMITED_BANK_H

#include "hyst/drive_limits.h"
#include "hyst/prandtl_ishlinskii.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    hyst_drive_limits drive;
    hyst_real v_low, v_high; /* below and above them the drive is beyond its limits, whatever the memory */
} hyst_bank_limits;

/* One sample; v must be finite. *held becomes 1 where the drive is not that of the bank, and stays as it
 * is where it is: then all bits are those of hyst_pi_step.
 * before: room for the plays; what is in it counts for nothing. */
hyst_real hyst_limited_bank_step(const hyst_pi *bank, const hyst_bank_limits *limits,
                                 hyst_real *state, hyst_real *before, int *held, hyst_real v);

#ifdef HYST_EXTERN_C
}
#endif

#endif
