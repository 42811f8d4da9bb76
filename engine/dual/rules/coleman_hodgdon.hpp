// The way to an output of Coleman and Hodgdon's, which Newton's method finds.
#include "hyst/coleman_hodgdon.h"
#define hyst_coleman_way iterated_way
#include "coleman_way.c"
#undef hyst_coleman_way

hyst_real hyst_coleman_way(hyst_real line, hyst_real bend, hyst_real w)
{
    const hyst_real x = iterated_way(line.v, bend.v, w.v).v;
    const double share = hyst_coleman_share(x).v;
    const double slope = line.v + bend.v * (1.0 - share);
    return {x.v, (w.d - x.v * line.d - share * bend.d) / slope};
}
