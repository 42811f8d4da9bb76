/* Generalized Maxwell-slip friction, one sample at a time. */
#include "hyst/generalized_maxwell_slip.h"

#include "hyst/finite.h"

/* Of each element: force, what rounding left out, and the way it slides. */
#define MAXWELL_SLIP_VALUES 3u

/* One element over a way > 0 towards sign, with what it may bear there, and the share of the distance
 * to it that sliding covers in this sample. */
static void maxwell_slip_element(hyst_real *element, hyst_real k, hyst_real limit, hyst_real sign,
                                 hyst_real way, hyst_real covered)
{
    const hyst_real zero = HYST_REAL(0.0);
    const hyst_real left = limit - sign * element[0];
    if (element[2] == sign || left < zero) {
        hyst_stribeck_add(element, sign * left * covered);
        element[2] = sign;
    } else if (k * way <= left) {
        hyst_stribeck_add(element, sign * k * way);
        element[2] = zero;
    } else {
        element[0] = sign * limit;
        element[1] = zero;
        element[2] = sign;
    }
}

hyst_real hyst_generalized_maxwell_slip_step(const hyst_generalized_maxwell_slip *model,
                                             hyst_real *state, hyst_real u)
{
    const hyst_real zero = HYST_REAL(0.0);
    const size_t count = model->count;
    hyst_real *last = state + MAXWELL_SLIP_VALUES * count;
    const hyst_real move = last[1] > zero ? u - last[0] : zero;
    const hyst_real sign = move < zero ? HYST_REAL(-1.0) : HYST_REAL(1.0);
    const hyst_real v = move * model->rate;
    const hyst_real x = sign * v * model->curve.rate;
    const hyst_real curve = hyst_stribeck_force(&model->curve, hyst_power(x, model->shape));
    const hyst_real covered = hyst_stribeck_share(model->attraction / curve);
    hyst_real total = model->viscosity * v;
    if (hyst_is_finite(total) == 0 || hyst_is_finite(v) == 0) {
        return total + v; /* a velocity beyond every number leaves the memory as it is */
    }
    for (size_t i = 0; i < count; ++i) {
        hyst_real *element = state + MAXWELL_SLIP_VALUES * i;
        if (sign * move > zero) {
            maxwell_slip_element(element, model->stiffness[i], model->share[i] * curve, sign,
                                 sign * move, covered);
        } else {
            element[2] = zero;
        }
        total += element[0];
    }
    last[0] = u;
    last[1] = HYST_REAL(1.0);
    return total;
}

static size_t generalized_maxwell_slip_length(const void *model)
{
    return MAXWELL_SLIP_VALUES * ((const hyst_generalized_maxwell_slip *)model)->count + 2u;
}

static hyst_real generalized_maxwell_slip_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_generalized_maxwell_slip_step((const hyst_generalized_maxwell_slip *)model, state,
                                              u);
}

const hyst_kind hyst_generalized_maxwell_slip_kind = {generalized_maxwell_slip_length,
                                                        generalized_maxwell_slip_step};
