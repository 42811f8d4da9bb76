/* A play whose half-width is a power of the rate of its input: what a switching material adds to
 * its thresholds when it is driven fast,
 *
 *     z_k = clamp(z_{k-1}, u_k - b_k, u_k + b_k),   b_k = c |(u_k - u_{k-1}) / dt|^m.
 *
 * A relay of thresholds beta < alpha behind it switches up where the rising input reaches
 * alpha + b and down where the falling one reaches beta - b. Coercive fields grow as a power of the
 * frequency: Y. Ishibashi and H. Orihara, Integrated Ferroelectrics 9 (1995) 57-61; J. F. Scott,
 * Integrated Ferroelectrics 12 (1996) 71-81. Thresholds that move with the rate of the input are
 * those of I. D. Mayergoyz, Mathematical Models of Hysteresis (1991), sec. II.4, in another form.
 *
 * State: z, the last input, and 1 once there is one: the first sample is taken to be at rest. */
#ifndef HYST_RATE_SHIFT_H
#define HYST_RATE_SHIFT_H

#include "hyst/kind.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    hyst_real shift;    /* c >= 0, half-width at a rate of 1 */
    hyst_real exponent; /* m > 0 */
    hyst_real per_time; /* 1 / dt */
} hyst_rate_shift;

hyst_real hyst_rate_shift_step(const hyst_rate_shift *model, hyst_real *state, hyst_real u);

extern const hyst_kind hyst_rate_shift_kind;

#ifdef HYST_EXTERN_C
}
#endif

#endif
