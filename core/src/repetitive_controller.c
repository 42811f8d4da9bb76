/* Memory of a period and inverse, limited or not, one sample at a time. */
#include "hyst/repetitive_controller.h"

hyst_real hyst_repetitive_step(const hyst_repetitive_memory *memory, const hyst_chain *inverse,
                               hyst_real *state, hyst_guard *guard, hyst_real y_ref, hyst_real y,
                               hyst_real *v, int *changed)
{
    const hyst_real wanted = hyst_repetitive_wanted(memory, state, y_ref, y, changed);
    const hyst_real drive = hyst_guarded_step(
        inverse, state + hyst_repetitive_memory_length(memory), guard, wanted);
    *v = hyst_is_finite(wanted) != 0 ? wanted : *v;
    hyst_repetitive_learn(memory, state, HYST_REAL(0.0));
    return drive;
}

hyst_real hyst_limited_repetitive_step(const hyst_repetitive_memory *memory,
                                       const hyst_limited_inverse *inverse, hyst_real *state,
                                       hyst_real *before, hyst_limited_guard *guard, hyst_real y_ref,
                                       hyst_real y, hyst_real *v, int *changed)
{
    const hyst_real wanted = hyst_repetitive_wanted(memory, state, y_ref, y, changed);
    hyst_real applied = wanted, excess = HYST_REAL(0.0);
    const hyst_real drive = hyst_limited_inverse_step(
        inverse, state + hyst_repetitive_memory_length(memory), before, guard, &applied);
    if (hyst_is_finite(wanted) != 0) {
        *v = applied;
        excess = applied - wanted;
    }
    hyst_repetitive_learn(memory, state, excess);
    return drive;
}
