/* Prandtl-Ishlinskii operator, one sample at a time. */
#include "hyst/prandtl_ishlinskii.h"

#include "hyst/play.h"

hyst_real hyst_pi_step(const hyst_pi *pi, hyst_real *z, hyst_real u)
{
    hyst_real y = pi->p0 * u;
    for (size_t i = 0; i < pi->count; ++i) {
        z[i] = hyst_play(u, pi->r[i], z[i]);
        y += pi->p[i] * z[i];
    }
    return y;
}
