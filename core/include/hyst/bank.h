/* The sum of a bank of plays: y = first + sum_i p_i z_i, z_i clamped to [low - r_i, high + r_i].
 *
 * Its order is part of what a model answers, so that all that steps a bank gives the same bits. Fewer
 * than HYST_WIDE_BANK plays are added to `first` one by one, in the order of i. Of a wide bank the
 * plays are taken four by four as far as that goes, those with i mod 4 = j in a sum s_j of their own, in
 * the order of i; then those that are left, three at most, one by one:
 *
 *     y = (first + ((s_0 + s_2) + (s_1 + s_3))) + p_i z_i + ..
 *
 * Four plays side by side halve the time of a step where the processor has vectors. Where it has none
 * they gain little, and to set them up costs a narrow bank more than it gains. */
#ifndef HYST_BANK_H
#define HYST_BANK_H

#include "hyst/play.h"
#include "hyst/prandtl_ishlinskii.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

#define HYST_WIDE_BANK 16u

/* One sample of a bank that is wide; moves the play outputs z. */
hyst_real hyst_wide_bank_step(const hyst_pi *bank, hyst_real *z, hyst_real low, hyst_real high,
                              hyst_real first);

/* One sample of any bank, whose p0 does not count: it is in `first`. */
static inline hyst_real hyst_bank_step(const hyst_pi *bank, hyst_real *z, hyst_real low,
                                       hyst_real high, hyst_real first)
{
    if (bank->count >= HYST_WIDE_BANK) {
        return hyst_wide_bank_step(bank, z, low, high, first);
    }
    /* Read once: a compiler that saves space would fetch them again for every play. */
    const size_t count = bank->count;
    const hyst_real *p = bank->p;
    const hyst_real *r = bank->r;
    hyst_real y = first;
    for (size_t i = 0; i < count; ++i) {
        const hyst_real moved = hyst_clamp(low - r[i], high + r[i], z[i]);
        z[i] = moved;
        y += p[i] * moved;
    }
    return y;
}

#ifdef HYST_EXTERN_C
}
#endif

#endif
