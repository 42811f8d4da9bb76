/* A delay by parts of a sample, one sample at a time. */
#include "hyst/delay.h"

#include "hyst/finite.h"

/* A count within the ring, whatever the state holds. */
static size_t counted(hyst_real value, size_t most)
{
    return value > HYST_REAL(0.0) && value <= (hyst_real)most ? (size_t)value : 0u;
}

hyst_real hyst_delay_step(const hyst_delay *model, hyst_real *state, hyst_real input)
{
    const size_t n = model->whole;
    hyst_real *ring = state + 2;
    const size_t place = counted(state[0], n), held = counted(state[1], n + 1u);
    const size_t next = place == n ? 0u : place + 1u;
    hyst_real u = input, y = input;
    if (held > 0u) {
        const hyst_real older = held > n ? ring[place] : ring[0];
        const hyst_real newer = n == 0u ? input : held > n ? ring[next] : ring[0];
        y = newer + model->fraction * (older - newer);
        u = model->inverse != 0 ? input + model->lead * (input - older) : input;
    }
    const hyst_real output = model->inverse != 0 ? u : y;
    const hyst_real zero = (u - u) + (output - output); /* unless one is not finite: then NaN */
    if (hyst_is_finite(zero) == 0) {
        return zero;
    }
    ring[place] = u;
    state[0] = (hyst_real)next;
    state[1] = (hyst_real)(held > n ? held : held + 1u);
    return output;
}

static size_t delay_length(const void *model)
{
    return ((const hyst_delay *)model)->whole + 3u;
}

static hyst_real delay_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_delay_step((const hyst_delay *)model, state, u);
}

const hyst_kind hyst_delay_kind = {delay_length, delay_step};
