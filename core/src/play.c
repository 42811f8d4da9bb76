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
