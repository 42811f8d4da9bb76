/* The guarded step: the only place of the core that looks for infinities and NaNs. */
#include "hyst/guard.h"

int hyst_is_finite(hyst_real value)
{
    /* inf - inf and NaN - NaN are NaN, and a NaN is not equal to zero. */
    const hyst_real difference = value - value;
    return difference >= HYST_REAL(0.0) && difference <= HYST_REAL(0.0);
}

hyst_real hyst_guarded_step(const hyst_chain *chain, hyst_real *state, hyst_guard *guard,
                            hyst_real u)
{
    /* Every stage is given a finite number or nothing: a finite input may overflow on its way. */
    for (size_t i = 0; i < chain->count && hyst_is_finite(u); ++i) {
        u = hyst_stage_step(&chain->stage[i], state, u);
        state += hyst_stage_state_length(&chain->stage[i]);
    }
    if (hyst_is_finite(u)) {
        guard->y_last = u;
    } else {
        guard->fault = 1;
    }
    return guard->y_last;
}
