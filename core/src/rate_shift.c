/* A play as wide as a power of the rate, one sample at a time. */
#include "hyst/rate_shift.h"

#include "hyst/finite.h"
#include "hyst/play.h"
#include "hyst/power.h"

hyst_real hyst_rate_shift_step(const hyst_rate_shift *model, hyst_real *state, hyst_real u)
{
    const hyst_real change = state[2] > HYST_REAL(0.0) ? u - state[1] : HYST_REAL(0.0);
    const hyst_real way = change < HYST_REAL(0.0) ? -change : change;
    const hyst_real shift = model->shift * hyst_power(way * model->per_time, model->exponent);
    /* A width that is no number is none: the state stays finite. */
    const hyst_real width = hyst_is_finite(shift) != 0 ? shift : HYST_REAL(0.0);
    const hyst_real z = hyst_clamp(u - width, u + width, state[0]);
    state[0] = z;
    state[1] = u;
    state[2] = HYST_REAL(1.0);
    return z;
}

static size_t rate_shift_length(const void *model)
{
    (void)model;
    return 3;
}

static hyst_real rate_shift_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_rate_shift_step((const hyst_rate_shift *)model, state, u);
}

const hyst_kind hyst_rate_shift_kind = {rate_shift_length, rate_shift_step};
