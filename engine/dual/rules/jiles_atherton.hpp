// The inverse of Langevin's function, and the field of a magnetization, which are iterated.
#include "hyst/langevin.h"
#define hyst_langevin_inverse iterated_langevin
#include "langevin.c"
#undef hyst_langevin_inverse

hyst_real hyst_langevin_inverse(hyst_real v)
{
    const hyst_real x = iterated_langevin(v.v).v;
    return {x.v, v.d / hyst_langevin_slope(x).v};
}

#include "hyst/jiles_atherton.h"
#define hyst_jiles_root iterated_root
#include "jiles_root.c"
#undef hyst_jiles_root

hyst_real hyst_jiles_root(const hyst_jiles_stretch *on, hyst_real target, hyst_real low,
                          hyst_real high)
{
    const hyst_real x = iterated_root(on, target, low, high).v;
    return {x.v, (target.d - hyst_jiles_sought(on, x).d) / hyst_jiles_slope(on, x).v};
}
