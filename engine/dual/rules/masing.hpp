// Loading curves: their inverses, and inputs that rest.
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
