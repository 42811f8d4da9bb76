/* Play and stop, one sample at a time. The equation itself is in play.h. */
#include "hyst/play.h"

hyst_real hyst_play_step(hyst_real r, hyst_real *z, hyst_real u)
{
    *z = hyst_play(u, r, *z);
    return *z;
}

hyst_real hyst_stop_step(hyst_real r, hyst_real *z, hyst_real u)
{
    *z = hyst_play(u, r, *z);
    return u - *z;
}

static size_t play_length(const void *model)
{
    (void)model;
    return 1;
}

static hyst_real play_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_play_step(*(const hyst_real *)model, state, u);
}

const hyst_kind hyst_play_kind = {play_length, play_step};

static size_t stop_length(const void *model)
{
    (void)model;
    return 1;
}

static hyst_real stop_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_stop_step(*(const hyst_real *)model, state, u);
}

const hyst_kind hyst_stop_kind = {stop_length, stop_step};
