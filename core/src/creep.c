/* Creep, one sample at a time. */
#include "hyst/creep.h"

#include "hyst/finite.h"

hyst_real hyst_creep_step(const hyst_creep *model, hyst_real *state, hyst_real input)
{
    const size_t count = model->count;
    hyst_real crept = HYST_REAL(0.0);
    for (size_t i = 0; i < count; ++i) {
        crept += model->weight[i] * state[2u * i];
    }
    const hyst_real output = model->inverse != 0 ? input - crept : input + crept;
    const hyst_real u = model->inverse != 0 ? output : input;
    hyst_real zero = output - output; /* unless a way is not finite: then NaN */
    for (size_t i = 0; i < count; ++i) {
        const hyst_real way = u - state[2u * i];
        zero += way - way;
    }
    if (hyst_is_finite(zero) == 0) {
        return zero;
    }
    for (size_t i = 0; i < count; ++i) {
        hyst_real *lag = state + 2u * i;
        const hyst_real step = model->gain[i] * (u - lag[0]) + lag[1];
        const hyst_real next = lag[0] + step;
        lag[1] = step - (next - lag[0]);
        lag[0] = next;
    }
    return output;
}

static size_t creep_length(const void *model)
{
    return 2u * ((const hyst_creep *)model)->count;
}

static hyst_real creep_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_creep_step((const hyst_creep *)model, state, u);
}

const hyst_kind hyst_creep_kind = {creep_length, creep_step};
