/* Prandtl-Ishlinskii operator, one sample at a time. */
#include "hyst/prandtl_ishlinskii.h"

#include "hyst/play.h"

hyst_real hyst_pi_step(const hyst_pi *pi, hyst_real *z, hyst_real u)
{
    /* Read once: a compiler that saves space would fetch them again for every play. */
    const size_t count = pi->count;
    const hyst_real *p = pi->p;
    const hyst_real *r = pi->r;
    hyst_real y = pi->p0 * u;
    for (size_t i = 0; i < count; ++i) {
        const hyst_real moved = hyst_play(u, r[i], z[i]);
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
