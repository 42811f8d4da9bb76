// The core's stages with tangents: their own sources once more, in a namespace, HYST_KINDS, that
// names how many tangents and which instruction set. A translation unit that includes this has no
// other core.
//
// Only functions of C are called, so that no inline function of the standard library is compiled
// for one instruction set and used in another (docs/decisions/0010).
#pragma once

#include <math.h>
#include <stddef.h>
#include <stdint.h>

#define HYST_REAL_HEADER "dual/real.h"
#define HYST_POWER_HEADER "dual/power.h"
#define HYST_ROOT_HEADER "dual/root.h"

namespace hyst {

// hyst_power, hyst_log2 and hyst_exp2 of the core in double.
double core_power(double x, double e);
double core_log2(double x);
double core_exp2(double v);
// hyst_root likewise.
double core_root(double x);

// Ways and shares of Bouc-Wen's branches in double; hyst/bouc_wen_branch.h.
double core_rising(double n, double join, double share);
double core_falling(double n, double ratio, double share);
double core_risen(double n, double join, double tilt, double from, double way);
double core_fallen(double n, double ratio, double tilt, double from, double way);

// What else of it is solved in double, its derivative given below.
double core_langevin(double x);
double core_langevin_slope(double x);
double core_langevin_inverse(double v);
double core_jiles_root(int variant, const double *constants, int rests, const double *stretch,
                       double target, const double *ends);

namespace HYST_KINDS {

// What solves an equation by iteration is differentiated by the implicit function theorem instead:
// from f(x) = w, df + f'(x) dx = dw. The derivative of the last iterate would lag behind its value
// by up to the square of the tolerance, and the iteration would carry tangents for nothing.
//
// Each kind with something to iterate has its rule in a file of dual/rules, and names there what of the
// core it stands for.
#include "rules.inc"       // made by CMakeLists.txt: the files of dual/rules
#include "hyst/loading_curve.h"
#define hyst_unloading iterated
#include "loading_curve.c"
#undef hyst_unloading

hyst_real hyst_unloading(const hyst_loading_curve *curve, hyst_real w)
{
    const hyst_real x = iterated(curve, w).v;
    const double slope = hyst_loading_slope(curve, x).v;
    return {x.v, (w.d - hyst_loading(curve, x).d) / slope};
}

// A loading curve answers an input that rests with the output it has stored. Its derivative is that
// of the input the sample before; what the input's has changed by goes along the branch.
#include "masing.c"
static hyst_real step_from_rest(const hyst_masing *model, hyst_real *state, hyst_real u)
{
    const hyst_real last = state[HYST_MASING_INPUT];
    hyst_real y = hyst_masing_step(model, state, u);
    if (u == last) {
        const size_t count = hyst_masing_reversals(model, state);
        const double along =
            count > 0 ? 0.5 * u.v - 0.5 * state[HYST_MASING_STACK + 2 * (count - 1)].v : u.v;
        const double x = model->inverse ? iterated(&model->curve, fabs(along)).v : fabs(along);
        const double slope = hyst_loading_slope(&model->curve, x).v;
        y.d = y.d + (model->inverse ? 1.0 / slope : slope) * (u.d - last.d);
        state[HYST_MASING_INPUT] = u;
        state[HYST_MASING_OUTPUT] = y;
    }
    return y;
}
#define hyst_masing_step step_from_rest

#include "branch.c"

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

// The Langevin function by its slopes, in double: L'' = -2 (L L' + L' / x - L / x^2), a series where
// that cancels.
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
    const double constants[] = {of.eta.v, of.kappa.v, of.c.v, of.width.v, of.reach.v};
    const double stretch[] = {on->sign.v,   on->rest.v, on->x_node.v,
                              on->y_node.v, on->by_x.v, on->by_m.v};
    const double ends[] = {low.v, at_low.v, high.v, at_high.v};
    const hyst_real x =
        ::hyst::core_jiles_root(of.variant, constants, on->rests, stretch, target.v, ends);
    hyst_real slope;
    const hyst_real at = hyst_jiles_sought(on, x, &slope);
    return {x.v, (target.d - at.d) / slope.v};
}

#include "core_kinds.inc"  // made by CMakeLists.txt: the sources that hold a kind, and the kinds

#undef hyst_masing_step

}  // namespace HYST_KINDS
}  // namespace hyst
