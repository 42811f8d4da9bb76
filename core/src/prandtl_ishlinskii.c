/* Prandtl-Ishlinskii operator, one sample at a time. */
#include "hyst/prandtl_ishlinskii.h"

#include "hyst/bank.h"

hyst_real hyst_pi_step(const hyst_pi *pi, hyst_real *z, hyst_real u)
{
    return hyst_bank_step(pi, z, u, u, pi->p0 * u);
}

hyst_real hyst_wide_bank_step(const hyst_pi *bank, hyst_real *z, hyst_real low, hyst_real high,
                              hyst_real first)
{
    const size_t count = bank->count;
    const hyst_real *p = bank->p;
    const hyst_real *r = bank->r;
    hyst_real s0 = HYST_REAL(0.0);
    hyst_real s1 = HYST_REAL(0.0);
    hyst_real s2 = HYST_REAL(0.0);
    hyst_real s3 = HYST_REAL(0.0);
    size_t i = 0;
    for (; i + 4u <= count; i += 4u) {
        /* All are read before one is written, or compilers would not put them side by side. */
        const hyst_real z0 = hyst_clamp(low - r[i], high + r[i], z[i]);
        const hyst_real z1 = hyst_clamp(low - r[i + 1u], high + r[i + 1u], z[i + 1u]);
        const hyst_real z2 = hyst_clamp(low - r[i + 2u], high + r[i + 2u], z[i + 2u]);
        const hyst_real z3 = hyst_clamp(low - r[i + 3u], high + r[i + 3u], z[i + 3u]);
        s0 += p[i] * z0;
        s1 += p[i + 1u] * z1;
        s2 += p[i + 2u] * z2;
        s3 += p[i + 3u] * z3;
        z[i] = z0;
        z[i + 1u] = z1;
        z[i + 2u] = z2;
        z[i + 3u] = z3;
    }
    hyst_real y = first + ((s0 + s2) + (s1 + s3));
    for (; i < count; ++i) {
        const hyst_real moved = hyst_clamp(low - r[i], high + r[i], z[i]);
        z[i] = moved;
        y += p[i] * moved;
    }
    return y;
}

static size_t pi_length(const void *model)
{
    return ((const hyst_pi *)model)->count;
}

static hyst_real pi_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_pi_step((const hyst_pi *)model, state, u);
}

const hyst_kind hyst_pi_kind = {pi_length, pi_step};
