/* Rate-dependent Prandtl-Ishlinskii operator, one sample at a time. */
#include "hyst/rate_dependent_prandtl_ishlinskii.h"

#include "hyst/bank.h"

hyst_real hyst_widening(const hyst_rate_dependent_pi *model, hyst_real x)
{
    hyst_real slope = HYST_REAL(0.0);
    for (size_t i = model->powers; i > 0u; --i) {
        slope = (slope + model->power[i - 1u]) * x;
    }
    const hyst_real widening =
        (slope + model->growth) * x + hyst_dead_zone_step(&model->ramps, x);
    return widening > HYST_REAL(0.0) ? widening : HYST_REAL(0.0);
}

hyst_real hyst_rate_dependent_pi_step(const hyst_rate_dependent_pi *model, hyst_real *state,
                                      hyst_real u)
{
    const hyst_pi *pi = &model->pi;
    hyst_real *last = state + pi->count;
    const hyst_real change = last[1] > HYST_REAL(0.0) ? u - last[0] : HYST_REAL(0.0);
    const hyst_real widening = hyst_widening(model, change < HYST_REAL(0.0) ? -change : change);
    const hyst_real low = u - widening;
    const hyst_real high = u + widening;
    const hyst_real y = hyst_bank_step(pi, state, low, high, pi->p0 * u);
    last[0] = u;
    last[1] = HYST_REAL(1.0);
    return y;
}

static size_t rate_dependent_pi_length(const void *model)
{
    return ((const hyst_rate_dependent_pi *)model)->pi.count + 2u;
}

static hyst_real rate_dependent_pi_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_rate_dependent_pi_step((const hyst_rate_dependent_pi *)model, state, u);
}

const hyst_kind hyst_rate_dependent_pi_kind = {rate_dependent_pi_length, rate_dependent_pi_step};
