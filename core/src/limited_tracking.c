/* Controller, disturbance observer and limited inverse, one sample at a time. */
#include "hyst/limited_tracking.h"

size_t hyst_limited_tracking_state_length(const hyst_limited_tracking *controller)
{
    return controller->linear.order + hyst_limited_inverse_state_length(&controller->inverse);
}

hyst_real hyst_limited_tracking_step(const hyst_limited_tracking *controller, hyst_real *state,
                                     hyst_real *before, hyst_limited_guard *guard, hyst_real y_ref,
                                     hyst_real y, hyst_real *v, hyst_real *excess)
{
    const size_t n = controller->linear.order;
    hyst_real wanted = (y_ref - y_ref) + (y - y); /* 0, or NaN which the limited inverse refuses */
    if (hyst_is_finite(wanted) != 0) {
        wanted = hyst_tracking_controller_linear(&controller->linear, state, y_ref, y);
    }
    hyst_real applied = wanted;
    const hyst_real drive =
        hyst_limited_inverse_step(&controller->inverse, state + n, before, guard, &applied);
    if (hyst_is_finite(wanted) != 0) {
        *v = applied;
        *excess = applied - wanted;
        hyst_tracking_take_back(n, controller->w, state, *excess);
    }
    return drive;
}
