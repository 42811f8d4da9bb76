/* Affine map, one sample. */
#include "hyst/affine.h"

hyst_real hyst_affine_step(const hyst_affine *map, hyst_real u)
{
    return map->gain * u + map->offset;
}

static size_t affine_length(const void *model)
{
    (void)model;
    return 0;
}

static hyst_real affine_step(const void *model, hyst_real *state, hyst_real u)
{
    (void)state;
    return hyst_affine_step((const hyst_affine *)model, u);
}

const hyst_kind hyst_affine_kind = {affine_length, affine_step};
