/* A first-order lag, one sample at a time. */
#include "hyst/lag.h"

#include "hyst/finite.h"

hyst_real hyst_lag_step(const hyst_lag *model, hyst_real *state, hyst_real input)
{
    const hyst_real y = state[0], before = state[2];
    if (!(state[3] > HYST_REAL(0.0))) {
        if (hyst_is_finite(input) != 0) {
            state[0] = input;
            state[1] = HYST_REAL(0.0);
            state[2] = input;
            state[3] = HYST_REAL(1.0);
        }
        return input;
    }
    const hyst_real way = model->gain * (before - y) + state[1];
    hyst_real u = input;
    if (model->inverse != 0) {
        u = before + ((input - y) - way) * model->per_through;
    }
    const hyst_real step = way + model->through * (u - before);
    const hyst_real next = y + step;
    const hyst_real carried = step - (next - y);
    const hyst_real zero = (carried - carried) + (u - u); /* unless one of all is not finite: then NaN */
    if (hyst_is_finite(zero) == 0) {
        return zero;
    }
    state[0] = next;
    state[1] = carried;
    state[2] = u;
    return model->inverse != 0 ? u : next;
}

static size_t lag_length(const void *model)
{
    (void)model;
    return 4u;
}

static hyst_real lag_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_lag_step((const hyst_lag *)model, state, u);
}

const hyst_kind hyst_lag_kind = {lag_length, lag_step};
