/* An inverse whose drive is limited, one sample at a time. */
#include "hyst/limited_inverse.h"

size_t hyst_limited_inverse_state_length(const hyst_limited_inverse *limited)
{
    return hyst_chain_state_length(&limited->inverse) + hyst_chain_state_length(&limited->forward) +
           1u;
}

hyst_real hyst_limited_inverse_step(const hyst_limited_inverse *limited, hyst_real *state,
                                    hyst_real *before, hyst_limited_guard *guard, hyst_real *v)
{
    if (!hyst_is_finite(*v)) {
        guard->guard.fault = 1;
        return guard->guard.y_last;
    }
    const size_t length = hyst_chain_state_length(&limited->inverse);
    hyst_real *const memory = state + length;
    hyst_real *const last = memory + hyst_chain_state_length(&limited->forward);
    for (size_t i = 0; i < length; ++i) {
        before[i] = state[i];
    }
    /* A drive that does not exist is answered by the last one, a v that does not by itself. */
    hyst_guard of_inverse = {*last, 0};
    hyst_guard of_forward = {*v, 0};
    const hyst_real u = hyst_guarded_step(&limited->inverse, state, &of_inverse, *v);
    const hyst_real drive = hyst_limited_drive(&limited->limits, last, u);
    const hyst_real applied = hyst_guarded_step(&limited->forward, memory, &of_forward, drive);
    if ((of_inverse.fault != 0) || (of_forward.fault != 0)) {
        guard->guard.fault = 1;
    }
    if ((of_inverse.fault != 0) || (drive < u) || (drive > u)) {
        for (size_t i = 0; i < length; ++i) {
            state[i] = before[i];
        }
        (void)hyst_guarded_step(&limited->inverse, state, &of_inverse, applied);
        *v = applied;
        guard->limited = 1;
    }
    guard->guard.y_last = drive;
    return drive;
}
