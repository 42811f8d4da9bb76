/* Controller, disturbance observer and inverse, one sample at a time. */
#include "hyst/tracking_controller.h"

size_t hyst_tracking_controller_state_length(const hyst_tracking_controller *controller)
{
    return controller->order + hyst_chain_state_length(&controller->inverse);
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
