/* Covariance in factors: measurement update, scaling, variances. */
#include "hyst/ud_factor.h"

hyst_real hyst_ud_update(size_t m, hyst_real *u, hyst_real *d, const hyst_real *psi,
                         hyst_real noise, hyst_real *gain, hyst_real *f)
{
    const hyst_real *column = u;
    for (size_t j = 0; j < m; column += j, ++j) {
        f[j] = psi[j];
        for (size_t i = 0; i < j; ++i) {
            f[j] += column[i] * psi[i];
        }
    }
    hyst_real a = noise;
    for (size_t j = 0; j < m; u += j, ++j) {
        const hyst_real v = d[j] * f[j];
        const hyst_real before = a;
        const hyst_real slope = -f[j] / before;
        a = before + v * f[j];
        d[j] *= before / a;
        for (size_t i = 0; i < j; ++i) {
            const hyst_real old = u[i];
            u[i] = old + slope * gain[i];
            gain[i] += v * old;
        }
        gain[j] = v;
    }
    return a;
}

void hyst_ud_scale(size_t m, hyst_real *u, hyst_real *d, const hyst_real *s)
{
    for (size_t j = 0; j < m; u += j, ++j) {
        const hyst_real share = HYST_REAL(1.0) / s[j];
        for (size_t i = 0; i < j; ++i) {
            u[i] *= s[i] * share;
        }
        d[j] *= s[j] * s[j];
    }
}

void hyst_ud_variances(size_t m, const hyst_real *u, const hyst_real *d, hyst_real *variance)
{
    for (size_t j = 0; j < m; u += j, ++j) {
        variance[j] = d[j];
        for (size_t i = 0; i < j; ++i) {
            variance[i] += u[i] * u[i] * d[j];
        }
    }
}

hyst_real hyst_ud_times(size_t m, const hyst_real *u, const hyst_real *d, const hyst_real *a,
                        hyst_real *product)
{
    hyst_real variance = HYST_REAL(0.0);
    for (size_t j = 0; j < m; u += j, ++j) {
        hyst_real f = a[j];
        for (size_t i = 0; i < j; ++i) {
            f += u[i] * a[i];
        }
        const hyst_real v = d[j] * f;
        variance += v * f;
        for (size_t i = 0; i < j; ++i) {
            product[i] += u[i] * v;
        }
        product[j] = v;
    }
    return variance;
}
