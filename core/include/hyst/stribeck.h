/* What friction slides at: the Stribeck curve, and the way a force approaches it.
 *
 *     s(v) = Fc + (Fs - Fc) exp(-|v / vs|^delta)
 *
 * R. Stribeck, Die wesentlichen Eigenschaften der Gleit- und Rollenlager, VDI-Zeitschrift 46 (1902)
 * 1341-1348; in this form Canudas de Wit, Olsson, Astrom and Lischinsky, IEEE Trans. Automatic Control
 * 40 (1995) 419-425, eq. 5. */
#ifndef HYST_STRIBECK_H
#define HYST_STRIBECK_H

#include "hyst/power.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    hyst_real coulomb; /* Fc > 0, the force of fast sliding */
    hyst_real excess;  /* Fs - Fc >= 0 */
    hyst_real rate;    /* 1 / vs > 0 */
} hyst_stribeck;

#define HYST_STRIBECK_LOG2_E HYST_REAL(1.4426950408889634)
/* Below this the exponential is summed, since 1 - exp(-x) has lost digits of x. */
#define HYST_STRIBECK_SMALL HYST_REAL(0.25)
/* exp(-x) of more than this is 0 in any precision. */
#define HYST_STRIBECK_FAR HYST_REAL(1e6)

/* s(v), given |v / vs|^delta. */
static inline hyst_real hyst_stribeck_force(const hyst_stribeck *curve, hyst_real power)
{
    hyst_real x = HYST_STRIBECK_FAR;
    if (power < HYST_STRIBECK_FAR) {
        x = power;
    }
    return curve->coulomb + curve->excess * hyst_exp2(-HYST_STRIBECK_LOG2_E * x);
}

/* 1 - exp(-x) of x >= 0, with all digits of a small x. */
static inline hyst_real hyst_stribeck_share(hyst_real x)
{
    if (x < HYST_STRIBECK_SMALL) {
        hyst_real sum = HYST_REAL(1.0);
        for (size_t k = 13; k > 1u; --k) {
            sum = HYST_REAL(1.0) - sum * x / (hyst_real)k;
        }
        return x * sum;
    }
    return HYST_REAL(1.0) - hyst_exp2(-HYST_STRIBECK_LOG2_E * x);
}

/* sum[0] + sum[1] += more, where sum[1] holds what rounding has left out of sum[0]: ways that are small
 * beside the digits of a force add up. */
static inline void hyst_stribeck_add(hyst_real *sum, hyst_real more)
{
    const hyst_real whole = more + sum[1];
    const hyst_real total = sum[0] + whole;
    sum[1] = whole - (total - sum[0]);
    sum[0] = total;
}

#ifdef HYST_EXTERN_C
}
#endif

#endif
