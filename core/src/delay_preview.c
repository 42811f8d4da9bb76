/* A delay by more than half a sample taken back by preview, one sample at a time. */
#include "hyst/delay_preview.h"

#include "hyst/finite.h"

/* A count within the ring, whatever the state holds. */
static size_t within_preview(hyst_real value, size_t most)
{
    return value > HYST_REAL(0.0) && value <= (hyst_real)most ? (size_t)value : 0u;
}

hyst_real hyst_delay_preview_step(const hyst_delay_preview *model, hyst_real *state, hyst_real y)
{
    const size_t n = model->ahead;
    hyst_real *ring = state + 2;
    const size_t place = within_preview(state[0], n), held = within_preview(state[1], n + 1u);
    size_t at = place;
    hyst_real u = y;
    for (size_t i = 0; i < n && held > 0u; ++i) {
        at = at == 0u ? n : at - 1u;
        const hyst_real before = i < held ? ring[at] : ring[0];
        u = before + model->lead * (before - u);
    }
    const hyst_real zero = (u - u) + (y - y); /* unless one is not finite: then NaN */
    if (hyst_is_finite(zero) == 0) {
        return zero;
    }
    ring[place] = y;
    state[0] = place == n ? HYST_REAL(0.0) : (hyst_real)(place + 1u);
    state[1] = (hyst_real)(held > n ? held : held + 1u);
    return u;
}

static size_t delay_preview_length(const void *model)
{
    return ((const hyst_delay_preview *)model)->ahead + 3u;
}

static hyst_real delay_preview_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_delay_preview_step((const hyst_delay_preview *)model, state, u);
}

const hyst_kind hyst_delay_preview_kind = {delay_preview_length, delay_preview_step};
