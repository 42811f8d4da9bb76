/* The guarded step: infinities and NaNs go no further than where they come up. */
#include "hyst/guard.h"

hyst_real hyst_guarded_step(const hyst_chain *chain, hyst_real *state, hyst_guard *guard,
                            hyst_real u)
{
    /* Every stage is given a finite number or nothing: a finite input may overflow on its way. */
    for (size_t i = 0; i < chain->count && hyst_is_finite(u); ++i) {
        if (i > 0u) {
            state += hyst_stage_state_length(&chain->stage[i - 1u]);
        }
        u = hyst_stage_step(&chain->stage[i], state, u);
    }
    if (hyst_is_finite(u)) {
        guard->y_last = u;
    } else {
        guard->fault = 1;
    }
    return guard->y_last;
}
