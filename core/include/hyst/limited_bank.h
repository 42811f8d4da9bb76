/* A bank of plays, the last stage of an inverse, in front of an actuator whose drive is limited.
 *
 *   u = bank(v);   where u may not be: u_a, the nearest that may, and v_a with bank(v_a) = u_a
 *
 * The answers of limited_inverse.h without the memory of the model in front. At an end of the drive v_a
 * follows from the memory of the plays at once: v is taken back to it, and the bank steps as ever, so that
 * its memory is that of an actuator driven by u_a. What is before the bank has no memory and is not asked
 * again.
 *
 * The slope is above 0 however many plays move, narrowest first, as in every exact inverse. Radii ascend.
 *
 * State: the plays, the last drive. */
#ifndef HYST_LIMITED_BANK_H
#define HYST_LIMITED_BANK_H

#include "hyst/prandtl_ishlinskii.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

/* What is known of an end of the drive: of the plays that move on the way there from most memories. Where
 * they do not, it takes longer; and `from` holds for all memories. */
typedef struct {
    size_t moved;       /* how many they are, the narrowest ones; */
    hyst_real slope;    /* p0 + the sum of their p; without any, that of the bank counts; */
    hyst_real constant; /* the sum of their p r, taken negative on the way up; */
    hyst_real from;     /* the end can be met by v beyond this one only; */
    hyst_real least;    /* the radius of the widest of them, less what rounding may take from it */
} hyst_bank_end;

typedef struct {
    hyst_real low, high; /* low < high */
    hyst_bank_end down, up;
} hyst_bank_limits;

/* One sample; v must be finite. *held becomes 1 where the drive is not that of the bank, and stays as it
 * is where it is: then all bits are those of hyst_pi_step. Where no drive belongs to v, which overflows,
 * the last one is kept. */
hyst_real hyst_limited_bank_step(const hyst_pi *bank, const hyst_bank_limits *limits,
                                 hyst_real *state, int *held, hyst_real v);

#ifdef HYST_EXTERN_C
}
#endif

#endif
