/* Preview of a rate-dependent Prandtl-Ishlinskii operator, one sample at a time. */
#include "hyst/rate_preview.h"

#include "hyst/finite.h"
#include "hyst/play.h"

/* Roughness over the squared gain; rounding over the largest change of the explicit inverse in the
 * window, and over the range there. The rival begins smooth, the plan is always improved sharp. */
static const hyst_real preview_stages[3][3] = {
    {HYST_REAL(0.5), HYST_REAL(0.3), HYST_REAL(0.04)},
    {HYST_REAL(0.1), HYST_REAL(0.05), HYST_REAL(0.007)},
    {HYST_REAL(0.05), HYST_REAL(0.01), HYST_REAL(0.001)}};

/* The rival's stage by its age. */
static const size_t preview_stage_of_age[HYST_PREVIEW_LIFE] = {0u, 0u, 1u, 1u, 2u};

/* A command within its limits; where there is none before it, it starts from that of the explicit
 * inverse. */
static hyst_real preview_held(const hyst_rate_preview *model, const hyst_real *last, hyst_real start,
                              hyst_real u)
{
    hyst_real held = u;
    if (model->slowed != 0) {
        const hyst_real from = last[1] > HYST_REAL(0.0) ? last[0] : start;
        held = hyst_clamp(from - model->change, from + model->change, held);
    }
    return model->ranged != 0 ? hyst_clamp(model->low, model->high, held) : held;
}

/* Passes a sample to a copy of the explicit inverse; what comes out is kept if it is finite. */
static hyst_real preview_guess(const hyst_rate_preview *model, const hyst_preview_places *at,
                               hyst_real *state, hyst_real y)
{
    const size_t memory = model->plays.pi.count + 2u;
    hyst_real *copy = state + at->scratch;
    hyst_real *own = state + at->guess;
    for (size_t i = 0; i < memory; ++i) {
        copy[i] = own[i];
    }
    const hyst_real start = hyst_rate_dependent_pi_step(&model->guess, copy, y);
    for (size_t i = 0; i < memory; ++i) {
        if (hyst_is_finite(start) != 0) {
            own[i] = copy[i];
        }
        copy[i] = HYST_REAL(0.0);
    }
    return start;
}

/* A plan's last command moved on, or the explicit inverse's where that would overflow. */
static hyst_real preview_grown(hyst_real last, hyst_real move, hyst_real start)
{
    return hyst_is_finite(last + move) != 0 ? last + move : start;
}

/* Puts a sample at the end of the window, which moves on once it is full; gives its length. */
static size_t preview_append(const hyst_rate_preview *model, const hyst_preview_places *at,
                             hyst_real *state, hyst_real y, hyst_real start)
{
    const size_t most = model->preview + 1u;
    hyst_real *known = state + at->scalars + HYST_PREVIEW_KNOWN;
    size_t length = (size_t)*known;
    if (length == most) {
        for (size_t k = at->target; k + 1u < at->scratch; ++k) {
            state[k] = state[k + 1u];
        }
        --length;
    }
    const size_t end = length;
    state[at->target + end] = y;
    state[at->start + end] = start;
    state[at->plan + end] = start;
    state[at->rival + end] = start;
    if (end > 0u) {
        const hyst_real move = start - state[at->start + end - 1u];
        state[at->plan + end] = preview_grown(state[at->plan + end - 1u], move, start);
        state[at->rival + end] = preview_grown(state[at->rival + end - 1u], move, start);
    }
    *known = (hyst_real)(length + 1u);
    return length + 1u;
}

/* Measures the window: how fast and how far the explicit inverse moves in it. */
static int preview_scales(const hyst_rate_preview *model, const hyst_preview_places *at,
                          const hyst_real *state, size_t length, hyst_preview_stage *scales)
{
    const hyst_pi *pi = &model->plays.pi;
    const hyst_real *start = state + at->start;
    hyst_real last = state[pi->count + 1u] > HYST_REAL(0.0) ? state[pi->count] : start[0];
    hyst_real low = last;
    hyst_real high = last;
    hyst_real most = HYST_REAL(0.0);
    for (size_t k = 0; k < length; ++k) {
        const hyst_real change = start[k] > last ? start[k] - last : last - start[k];
        most = change > most ? change : most;
        low = start[k] < low ? start[k] : low;
        high = start[k] > high ? start[k] : high;
        last = start[k];
    }
    scales->gain = pi->p0;
    for (size_t i = 0; i < pi->count; ++i) {
        scales->gain += pi->p[i] < HYST_REAL(0.0) ? -pi->p[i] : pi->p[i];
    }
    scales->roughness = scales->gain * scales->gain;
    scales->rate = most;
    scales->contact = high - low;
    /* So small that the corners have no width left is no movement. */
    return most > HYST_REAL(0.0) && hyst_is_finite(HYST_REAL(1e6) / most) != 0 &&
           hyst_is_finite(scales->contact) != 0;
}

static hyst_preview_stage preview_stage(const hyst_preview_stage *scales, size_t number)
{
    const hyst_real *size = preview_stages[number];
    const hyst_preview_stage stage = {size[0] * scales->roughness, size[1] * scales->rate,
                                      size[2] * scales->contact, scales->gain};
    return stage;
}

/* Improves plan and rival once each. */
static void preview_plan(const hyst_rate_preview *model, const hyst_preview_places *at,
                         hyst_real *state, size_t length, const hyst_preview_stage *scales)
{
    hyst_real *plan = state + at->plan;
    hyst_real *rival = state + at->rival;
    hyst_real *damping = state + at->scalars + HYST_PREVIEW_DAMPING;
    hyst_real *age = state + at->scalars + HYST_PREVIEW_AGE;
    const hyst_preview_stage sharp = preview_stage(scales, 2u);
    const hyst_real cost =
        hyst_preview_improve(model, at, state, length, &sharp, plan, &damping[0]);
    const size_t passed = (size_t)*age;
    if (passed == 0u) {
        damping[1] = HYST_REAL(1e-4);
        for (size_t k = 0; k < length; ++k) {
            rival[k] = state[at->start + k];
        }
    }
    const hyst_preview_stage own = preview_stage(scales, preview_stage_of_age[passed]);
    const hyst_real other =
        hyst_preview_improve(model, at, state, length, &own, rival, &damping[1]);
    *age = (hyst_real)(passed + 1u);
    if (passed + 1u == HYST_PREVIEW_LIFE) {
        *age = HYST_REAL(0.0);
        if (other < cost) {
            damping[0] = damping[1];
            for (size_t k = 0; k < length; ++k) {
                plan[k] = rival[k];
            }
        }
    }
    for (size_t k = at->scratch; k < at->end; ++k) {
        state[k] = HYST_REAL(0.0);
    }
}

hyst_real hyst_rate_preview_step(const hyst_rate_preview *model, hyst_real *state, hyst_real y)
{
    const hyst_preview_places at = hyst_preview_layout(model);
    hyst_real *scalars = state + at.scalars;
    hyst_real *last = state + model->plays.pi.count;
    const hyst_real start = preview_guess(model, &at, state, y);
    if (hyst_is_finite(start) == 0) {
        return start - start;
    }
    const int first = !(scalars[HYST_PREVIEW_KNOWN] > HYST_REAL(0.0));
    const size_t length = preview_append(model, &at, state, y, start);
    if (first != 0) {
        scalars[HYST_PREVIEW_DAMPING] = HYST_REAL(1e-4);
        if (!(scalars[HYST_PREVIEW_BEGUN] > HYST_REAL(0.0))) {
            const hyst_real held = preview_held(model, last, start, start);
            (void)hyst_rate_dependent_pi_step(&model->plays, state, held);
        }
    }
    hyst_preview_stage scales;
    if (preview_scales(model, &at, state, length, &scales) != 0) {
        preview_plan(model, &at, state, length, &scales);
    } else {
        for (size_t k = 0; k < length; ++k) {
            state[at.plan + k] = state[at.start + k];
        }
    }
    const hyst_real u = preview_held(model, last, state[at.start], state[at.plan]);
    if (length <= model->preview) {
        return last[1] > HYST_REAL(0.0) ? last[0] : u;
    }
    (void)hyst_rate_dependent_pi_step(&model->plays, state, u);
    return u;
}

static size_t rate_preview_length(const void *model)
{
    return hyst_preview_layout((const hyst_rate_preview *)model).end;
}

static hyst_real rate_preview_step(const void *model, hyst_real *state, hyst_real y)
{
    return hyst_rate_preview_step((const hyst_rate_preview *)model, state, y);
}

const hyst_kind hyst_rate_preview_kind = {rate_preview_length, rate_preview_step};
