/* The row of stages inside a stage. An export calls the stages one by one and then the map, so that
 * it has no table of functions; the operations are the same. */
#include "hyst/state_map.h"

#include "hyst/finite.h"

static size_t state_map_length(const void *model)
{
    const hyst_chain *inside = &((const hyst_state_map *)model)->inside;
    size_t length = 0;
    for (size_t i = 0; i < inside->count; ++i) {
        length += inside->stage[i].kind->length(inside->stage[i].model);
    }
    return length;
}

/* Every stage is given a finite number or nothing, as in a chain. */
static hyst_real state_map_step(const void *model, hyst_real *state, hyst_real u)
{
    const hyst_state_map *own = (const hyst_state_map *)model;
    hyst_real z = u;
    for (size_t i = 0; i < own->inside.count; ++i) {
        const hyst_stage *each = &own->inside.stage[i];
        z = each->kind->step(each->model, state, z);
        if (!hyst_is_finite(z)) {
            return z;
        }
        state += each->kind->length(each->model);
    }
    return hyst_state_polynomial_value(&own->map, u, z);
}

const hyst_kind hyst_state_map_kind = {state_map_length, state_map_step};
