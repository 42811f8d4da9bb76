// Ways along a branch of Bouc-Wen's by the form of any n, since that of n = 1 has no derivative by n; and
// shares from the equation they solve.
#define hyst_bouc_wen_rising rising_in_double
#define hyst_bouc_wen_falling falling_in_double
#define hyst_bouc_wen_risen iterated_rise
#define hyst_bouc_wen_fallen iterated_fall
#include "hyst/bouc_wen_branch.h"
#include "bouc_wen_branch.c"
#undef hyst_bouc_wen_rising
#undef hyst_bouc_wen_falling
#undef hyst_bouc_wen_risen
#undef hyst_bouc_wen_fallen

hyst_real hyst_bouc_wen_rising(hyst_real n, hyst_real join, hyst_real share)
{
    hyst_real q;
    const hyst_real way = bouc_wen_rise(n, join, share, 1.0 - share, &q);
    return {core_rising(n.v, join.v, share.v), way.d};
}

hyst_real hyst_bouc_wen_falling(hyst_real n, hyst_real ratio, hyst_real share)
{
    return {core_falling(n.v, ratio.v, share.v), bouc_wen_fall(n, ratio, share).d};
}

hyst_real hyst_bouc_wen_risen(hyst_real n, hyst_real join, hyst_real tilt, hyst_real from,
                              hyst_real way)
{
    const hyst_real share = core_risen(n.v, join.v, tilt.v, from.v, way.v);
    if (!(share.v < 1.0)) {
        return share; // at the limit, wherever it came from
    }
    hyst_real q, at;
    const hyst_real there = bouc_wen_rise(n, join, share, 1.0 - share, &q) + tilt * share;
    const hyst_real here = bouc_wen_rise(n, join, from, 1.0 - from, &at) + tilt * from + way;
    return {share.v, (here.d - there.d) / (1.0 / q.v + tilt.v)};
}

hyst_real hyst_bouc_wen_fallen(hyst_real n, hyst_real ratio, hyst_real tilt, hyst_real from,
                               hyst_real way)
{
    const hyst_real share = core_fallen(n.v, ratio.v, tilt.v, from.v, way.v);
    const hyst_real there = bouc_wen_fall(n, ratio, share) + tilt * share;
    const hyst_real here = bouc_wen_fall(n, ratio, from) + tilt * from - way;
    const double slope = 1.0 / (1.0 + ratio.v * core_power(share.v, n.v)) + tilt.v;
    return {share.v, (here.d - there.d) / slope};
}
