/* Controller, disturbance observer and inverse, one sample at a time. */
#include "hyst/tracking_controller.h"

size_t hyst_tracking_controller_state_length(const hyst_tracking_controller *controller)
{
    return controller->order + hyst_chain_state_length(&controller->inverse);
}

hyst_real hyst_tracking_controller_linear(const hyst_tracking_controller *controller, hyst_real *x,
                                          hyst_real y_ref, hyst_real y)
{
    const size_t n = controller->order;
    hyst_real next[HYST_LARGEST_ORDER];
    hyst_real v = controller->d[0] * y_ref + controller->d[1] * y;
    for (size_t i = 0; i < n; ++i) {
        next[i] = controller->b[i] * y_ref + controller->b[n + i] * y;
    }
    /* Column after column: the sums of all rows run side by side. */
    for (size_t j = 0; j < n; ++j) {
        const hyst_real *column = controller->a + j * n;
        const hyst_real xj = x[j];
        v += controller->c[j] * xj;
        for (size_t i = 0; i < n; ++i) {
            next[i] += column[i] * xj;
        }
    }
    hyst_real zero = v - v; /* unless something is not finite: then NaN */
    for (size_t i = 0; i < n; ++i) {
        zero += next[i] - next[i];
    }
    const int finite = hyst_is_finite(zero);
    for (size_t i = 0; i < n; ++i) {
        x[i] = finite ? next[i] : x[i];
    }
    return finite ? v : zero;
}

hyst_real hyst_tracking_controller_step(const hyst_tracking_controller *controller,
                                        hyst_real *state, hyst_real y_ref, hyst_real y)
{
    const hyst_real v = hyst_tracking_controller_linear(controller, state, y_ref, y);
    return hyst_chain_step(&controller->inverse, state + controller->order, v);
}

hyst_real hyst_guarded_tracking_step(const hyst_tracking_controller *controller, hyst_real *state,
                                     hyst_guard *guard, hyst_real y_ref, hyst_real y)
{
    hyst_real v = (y_ref - y_ref) + (y - y); /* 0, or NaN which the chain's guard refuses */
    if (hyst_is_finite(v)) {
        v = hyst_tracking_controller_linear(controller, state, y_ref, y);
    }
    return hyst_guarded_step(&controller->inverse, state + controller->order, guard, v);
}
