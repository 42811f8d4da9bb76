/* LuGre friction, one sample at a time. */
#include "hyst/lugre.h"

#include "hyst/finite.h"

hyst_real hyst_lugre_step(const hyst_lugre *model, hyst_real *state, hyst_real u)
{
    const hyst_real zero = HYST_REAL(0.0);
    const hyst_real move = state[3] > zero ? u - state[0] : zero;
    const hyst_real sign = move < zero ? HYST_REAL(-1.0) : HYST_REAL(1.0);
    const hyst_real way = sign * move;
    const hyst_real v = move * model->rate;
    const hyst_real x = v * model->curve.rate;
    const hyst_real limit = hyst_stribeck_force(&model->curve, x * x);
    hyst_real force[2] = {state[1], state[2]};
    if (way > zero) {
        const hyst_real share = hyst_stribeck_share(model->stiffness * way / limit);
        hyst_stribeck_add(force, (sign * limit - state[1]) * share);
    }
    /* dz/dt = v (1 - sgn v w / s), in the order that overflows last. */
    const hyst_real slip = model->damping * (HYST_REAL(1.0) - sign * force[0] / limit);
    hyst_real total = force[0] + (slip + model->viscosity) * v;
    if (way > zero) {
        /* tanh(q) = (1 - e) / (1 + e) of e = exp(-2 q), with all digits of a small q. */
        const hyst_real gone = hyst_stribeck_share(HYST_REAL(2.0) * sign * v * model->thin);
        total += sign * model->thinning * gone / (HYST_REAL(2.0) - gone);
    }
    if (hyst_is_finite(total) == 0 || hyst_is_finite(force[0]) == 0) {
        return total; /* a velocity beyond every number leaves the memory as it is */
    }
    state[0] = u;
    state[1] = force[0];
    state[2] = force[1];
    state[3] = HYST_REAL(1.0);
    return total;
}

static size_t lugre_length(const void *model)
{
    (void)model;
    return 4;
}

static hyst_real lugre_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_lugre_step((const hyst_lugre *)model, state, u);
}

const hyst_kind hyst_lugre_kind = {lugre_length, lugre_step};
