// Of Jiles and Atherton: the field of a magnetisation, which is iterated, and the Langevin function by its
// slopes, all in double: L'' = -2 (L L' + L' / x - L / x^2), a series where that cancels.
#include "hyst/langevin.h"

hyst_real hyst_langevin(hyst_real x)
{
    return {::hyst::core_langevin(x.v), ::hyst::core_langevin_slope(x.v) * x.d};
}

hyst_real hyst_langevin_slope(hyst_real x)
{
    const double v = x.v, s = v * v;
    const double value = ::hyst::core_langevin(v), slope = ::hyst::core_langevin_slope(v);
    const double curvature =
        s < 0.09 ? v * (-2.0 / 15.0 + s * (8.0 / 189.0 + s * (-2.0 / 225.0 + s * (16.0 / 10395.0))))
                 : -2.0 * (value * slope + (slope - value / v) / v);
    return {slope, curvature * x.d};
}

hyst_real hyst_langevin_inverse(hyst_real v)
{
    const double x = ::hyst::core_langevin_inverse(v.v);
    return {x, (1.0 / ::hyst::core_langevin_slope(x)) * v.d};
}

#include "hyst/jiles_atherton.h"

hyst_real hyst_jiles_root(const hyst_jiles_stretch *on, hyst_real target, hyst_real low,
                          hyst_real at_low, hyst_real high, hyst_real at_high)
{
    const hyst_jiles_atherton &of = *on->model;
    const double constants[] = {of.eta.v,   of.kappa.v,   of.c.v,      of.width.v,
                                of.reach.v, of.x_share.v, of.m_share.v};
    const double stretch[] = {on->sign.v,   on->rest.v, on->x_node.v,
                              on->y_node.v, on->by_x.v, on->by_m.v,
                              on->excess.v, on->last.v, on->x_last.v};
    const double ends[] = {low.v, at_low.v, high.v, at_high.v};
    const hyst_real x =
        ::hyst::core_jiles_root(of.variant, of.loses, constants, on->rests, stretch, target.v, ends);
    hyst_real slope;
    const hyst_real at = hyst_jiles_sought(on, x, &slope);
    return {x.v, (target.d - at.d) / slope.v};
}
