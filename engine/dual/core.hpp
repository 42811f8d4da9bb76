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

namespace HYST_KINDS {

// What solves an equation by iteration is differentiated by the implicit function theorem instead:
// from f(x) = w, df + f'(x) dx = dw. The derivative of the last iterate would lag behind its value
// by up to the square of the tolerance, and the iteration would carry tangents for nothing.
#include "hyst/loading_curve.h"
#define hyst_unloading iterated
#include "loading_curve.c"
#undef hyst_unloading

hyst_real hyst_unloading(const hyst_loading_curve *curve, hyst_real w)
{
    const hyst_real x = iterated(curve, w).v;
    const double slope = hyst_loading_slope(curve, x).v;
    if (!(slope > 0.0)) return x.v;  // a curve that starts flat: no derivative to speak of
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

// The pieces that hyst_preisach_step is made of; the file that holds a kind does not hold them.
#include "preisach_branch.c"
#include "state_polynomial.c"
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

// The pieces that hyst_preisach_step is made of; the file that holds a kind does not hold them.
#include "preisach_branch.c"
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
    hyst_real q;
    const hyst_real way = bouc_wen_rise(n, join, share, 1.0 - share, &q);
    return {core_rising(n.v, join.v, share.v), way.d};
}

hyst_real hyst_bouc_wen_falling(hyst_real n, hyst_real ratio, hyst_real share)
    return {core_falling(n.v, ratio.v, share.v), bouc_wen_fall(n, ratio, share).d};
}

hyst_real hyst_bouc_wen_risen(hyst_real n, hyst_real join, hyst_real tilt, hyst_real from,
                              hyst_real way)
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
    const hyst_real share = core_fallen(n.v, ratio.v, tilt.v, from.v, way.v);
    const hyst_real there = bouc_wen_fall(n, ratio, share) + tilt * share;
    const hyst_real here = bouc_wen_fall(n, ratio, from) + tilt * from - way;
    const double slope = 1.0 / (1.0 + ratio.v * core_power(share.v, n.v)) + tilt.v;
    return {share.v, (here.d - there.d) / slope};
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

#include "core_kinds.inc"  // made by CMakeLists.txt: the sources that hold a kind, and the kinds

#undef hyst_masing_step

}  // namespace HYST_KINDS
}  // namespace hyst
