/* A covariance P = U D U', U unit upper triangular, D diagonal, kept as its factors: P then stays
 * symmetric and positive semidefinite whatever rounding does.
 *
 * Update: G. J. Bierman, Factorization Methods for Discrete Sequential Estimation (1977), ch. V.
 * For m parameters: update 1.5 m^2 + 5.5 m multiplications or additions each and 2 m + 1 divisions,
 * scaling m^2 + 3 m multiplications and m divisions, variances m^2 multiplications. */
#ifndef HYST_UD_FACTOR_H
#define HYST_UD_FACTOR_H

#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

/* Length of the packed U of m parameters: column j = 1 .. m - 1 holds its j entries above the 1. */
static inline size_t hyst_ud_length(size_t m)
{
    return m * (m - 1u) / 2u;
}

/* One measurement y = psi' theta + noise of variance `noise` > 0. Writes the unscaled gain into
 * gain[m] and returns the innovation variance a = psi' P psi + noise; the gain of theta is gain / a.
 * A parameter with d_j = 0 and no entries of U in its row keeps its value. f: scratch of length m. */
hyst_real hyst_ud_update(size_t m, hyst_real *u, hyst_real *d, const hyst_real *psi,
                         hyst_real noise, hyst_real *gain, hyst_real *f);

/* P := S P S with S = diag(s), s_i > 0. */
void hyst_ud_scale(size_t m, hyst_real *u, hyst_real *d, const hyst_real *s);

/* Writes P a into product[m] and returns a' P a. */
hyst_real hyst_ud_times(size_t m, const hyst_real *u, const hyst_real *d, const hyst_real *a,
                        hyst_real *product);

/* The diagonal of P. */
void hyst_ud_variances(size_t m, const hyst_real *u, const hyst_real *d, hyst_real *variance);

#ifdef HYST_EXTERN_C
}
#endif

#endif
