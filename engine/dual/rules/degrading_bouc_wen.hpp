// Ways along a branch of Bouc-Wen's model that degrades, which Newton's method finds.
#include "hyst/degrading_branch.h"
#include "degrading_branch.c"
#define hyst_degrading_root iterated_degrading_root
#include "degrading_root.c"
#undef hyst_degrading_root

hyst_real hyst_degrading_root(const hyst_degrading *model, hyst_degrading_point at,
                              hyst_real by_way, hyst_real target, hyst_real far)
{
    const hyst_real x = iterated_degrading_root(model, at, by_way, target, far).v;
    const hyst_degrading_point there = hyst_degrading_advance(model, at, x);
    const double slope = by_way.v + hyst_degrading_slope(model, there).share.v;
    return {x.v, (target.d - (by_way * x + there.share).d) / slope};
}
