/* The row of loading curves with memory of reversals. In a file of its own, since a second caller of
 * the step would change how compilers inline it: an export's step is compiled as if it were alone. */
#include "hyst/masing.h"

static size_t masing_length(const void *model)
{
    return hyst_masing_state_length((const hyst_masing *)model);
}

static hyst_real masing_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_masing_step((const hyst_masing *)model, state, u);
}

const hyst_kind hyst_masing_kind = {masing_length, masing_step};
