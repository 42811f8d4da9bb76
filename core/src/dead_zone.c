/* Dead-zone maps: the sum is taken in the order of the terms, so results repeat to the bit. */
#include "hyst/dead_zone.h"

static hyst_real two_sided(hyst_real u, hyst_real rho)
{
    const hyst_real excess = u - rho;
    const hyst_real zero = HYST_REAL(0.0);
    if (rho > zero) {
        return excess > zero ? excess : zero;
    }
    if (rho < zero) {
        return excess < zero ? excess : zero;
    }
    return u;
}

static hyst_real by_direction(hyst_real u_previous, hyst_real u, hyst_real rho)
{
    if (u > u_previous && u > rho) {
        return u - rho;
    }
    if (u < u_previous && u < -rho) {
        return u + rho;
    }
    return HYST_REAL(0.0);
}

hyst_real hyst_dead_zone_step(const hyst_dead_zone *map, hyst_real u)
{
    const size_t count = map->count;
    const hyst_real *weight = map->weight;
    const hyst_real *threshold = map->threshold;
    hyst_real y = HYST_REAL(0.0);
    for (size_t i = 0; i < count; ++i) {
        y += weight[i] * two_sided(u, threshold[i]);
    }
    return y;
}

hyst_real hyst_direction_dead_zone_step(const hyst_dead_zone *map, hyst_real *u_previous,
                                        hyst_real u)
{
    const size_t count = map->count;
    const hyst_real *weight = map->weight;
    const hyst_real *threshold = map->threshold;
    const hyst_real before = *u_previous;
    hyst_real y = HYST_REAL(0.0);
    for (size_t i = 0; i < count; ++i) {
        y += weight[i] * by_direction(before, u, threshold[i]);
    }
    *u_previous = u;
    return y;
}

static size_t dead_zone_length(const void *model)
{
    (void)model;
    return 0;
}

static hyst_real dead_zone_step(const void *model, hyst_real *state, hyst_real u)
{
    (void)state;
    return hyst_dead_zone_step((const hyst_dead_zone *)model, u);
}

const hyst_kind hyst_dead_zone_kind = {dead_zone_length, dead_zone_step};

static size_t direction_dead_zone_length(const void *model)
{
    (void)model;
    return 1;
}

static hyst_real direction_dead_zone_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_direction_dead_zone_step((const hyst_dead_zone *)model, state, u);
}

const hyst_kind hyst_direction_dead_zone_kind = {direction_dead_zone_length, direction_dead_zone_step};
