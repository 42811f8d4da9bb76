/* The hysteresis of Jiles and Atherton, one sample at a time. */
#include "hyst/jiles_atherton.h"

#include "hyst/branch.h"
#include "hyst/finite.h"
#include "hyst/langevin.h"
#include "hyst/power.h"

#define JILES_LOG2_E HYST_REAL(1.4426950408889634)
/* Doublings of the end of the last stretch at most. */
#define JILES_DOUBLINGS 60u

/* The share of L that m follows while the pinned part rests. */
static hyst_real jiles_reversible(const hyst_jiles_atherton *of)
{
    return of->variant == HYST_JILES_1986 ? of->c / (HYST_REAL(1.0) + of->c) : of->c;
}

/* Y' on the second stretch. */
static hyst_real jiles_change(const void *model, hyst_real x, hyst_real y, hyst_real sign)
{
    const hyst_jiles_atherton *of = (const hyst_jiles_atherton *)model;
    const hyst_real one = HYST_REAL(1.0);
    const hyst_real anhysteretic = hyst_langevin_slope(x);
    const hyst_real pull = sign * of->kappa;
    switch (of->variant) {
    case HYST_JILES_1992: {
        const hyst_real held = one - of->c;
        const hyst_real lag = y / held;
        const hyst_real moved = pull * lag * (one - of->eta * of->c * anhysteretic) /
                                (one - of->eta * of->c * pull * lag);
        return held * (anhysteretic - moved);
    }
    case HYST_JILES_1986: {
        const hyst_real pulled = pull * y;
        return anhysteretic - (pulled + of->c * anhysteretic * (one - of->eta * pulled)) /
                                  (one + of->c - of->eta * of->c * pulled);
    }
    case HYST_JILES_EFFECTIVE_FIELD:
    default:
        return (one - of->c) * anhysteretic - pull * y;
    }
}

/* Y far from the middle once the way since the turn is forgotten: L' = 1 / x^2 there, and
 * Y = gain / (kappa x^2) (1 + 2 / (r x) + 6 / (r x)^2 + ..), r the rate of forgetting, v = s x. */
static hyst_real jiles_tail(const hyst_jiles_atherton *of, hyst_real v, hyst_real rate)
{
    const hyst_real gain =
        of->variant == HYST_JILES_1986 ? HYST_REAL(1.0) : HYST_REAL(1.0) - of->c;
    const hyst_real t = HYST_REAL(1.0) / (rate * v);
    hyst_real sum = HYST_REAL(1.0);
    for (size_t k = 6; k > 1u; --k) {
        sum = HYST_REAL(1.0) + (hyst_real)k * t * sum;
    }
    return gain / of->kappa / (v * v) * sum;
}

static hyst_real jiles_rate(const hyst_jiles_atherton *of)
{
    return of->variant == HYST_JILES_1986 ? of->kappa / (HYST_REAL(1.0) + of->c) : of->kappa;
}

static int jiles_is_far(const hyst_jiles_stretch *on)
{
    const hyst_real v = on->sign * on->x_node;
    return v >= on->model->reach || v < -on->model->reach;
}

/* Y at x, from the node. */
static hyst_real jiles_y(const hyst_jiles_stretch *on, hyst_real x)
{
    const hyst_jiles_atherton *of = on->model;
    const hyst_real way = on->sign * (x - on->x_node);
    if (jiles_is_far(on)) {
        const hyst_real rate = jiles_rate(of);
        const hyst_real slow = on->sign * jiles_tail(of, on->sign * x, rate);
        const hyst_real before = on->sign * jiles_tail(of, on->sign * on->x_node, rate);
        return slow + (on->y_node - before) * hyst_exp2(-JILES_LOG2_E * rate * way);
    }
    const hyst_branch_equation equation = {of, jiles_change, of->width};
    return hyst_branch_advance(&equation, on->x_node, on->y_node, on->sign, way);
}

hyst_real hyst_jiles_m(const hyst_jiles_stretch *on, hyst_real x)
{
    if (on->rests != 0) {
        return jiles_reversible(on->model) * hyst_langevin(x) + on->rest;
    }
    return hyst_langevin(x) - jiles_y(on, x);
}

/* The excess field at x and m; what it adds to the slope of what is sought. */
static hyst_real jiles_excess(const hyst_jiles_stretch *on, hyst_real x, hyst_real m,
                              hyst_real m_slope, hyst_real *slope)
{
    const hyst_real zero = HYST_REAL(0.0);
    const hyst_jiles_atherton *of = on->model;
    if (of->loses == 0) {
        return zero;
    }
    const hyst_real moved = of->x_share * x + of->m_share * m - on->last;
    const hyst_real size = moved < zero ? -moved : moved;
    if (!(size > zero)) {
        return zero; /* where the slope is none that is finite */
    }
    const hyst_real root = hyst_power(size, HYST_REAL(0.5));
    *slope = *slope + HYST_REAL(0.5) * on->excess * (of->x_share + of->m_share * m_slope) / root;
    return moved < zero ? -(on->excess * root) : on->excess * root;
}

hyst_real hyst_jiles_sought(const hyst_jiles_stretch *on, hyst_real x, hyst_real *slope)
{
    const hyst_real value = hyst_langevin(x), anhysteretic = hyst_langevin_slope(x);
    if (on->rests != 0) {
        const hyst_real reversible = jiles_reversible(on->model);
        const hyst_real m_slope = reversible * anhysteretic;
        const hyst_real m = reversible * value + on->rest;
        *slope = on->by_x + on->by_m * m_slope;
        return on->by_x * x + on->by_m * m + jiles_excess(on, x, m, m_slope, slope);
    }
    const hyst_real y = jiles_y(on, x);
    const hyst_real m_slope = anhysteretic - jiles_change(on->model, x, y, on->sign);
    *slope = on->by_x + on->by_m * m_slope;
    return on->by_x * x + on->by_m * (value - y) + jiles_excess(on, x, value - y, m_slope, slope);
}

/* What is sought, at the node. */
static hyst_real jiles_at_node(const hyst_jiles_stretch *on)
{
    const hyst_real m = hyst_langevin(on->x_node) - on->y_node;
    hyst_real slope = HYST_REAL(0.0);
    return on->by_x * on->x_node + on->by_m * m +
           jiles_excess(on, on->x_node, m, HYST_REAL(0.0), &slope);
}

/* The node after this one; 0 where there is none. */
static int jiles_next(const hyst_jiles_stretch *on, hyst_jiles_stretch *after)
{
    const hyst_real reach = on->model->reach;
    const hyst_real v = on->sign * on->x_node;
    if (v >= reach) {
        return 0;
    }
    *after = *on;
    after->x_node = on->sign * (v < -reach ? -reach : v + on->model->width);
    after->y_node = jiles_y(on, after->x_node);
    return 1;
}

static hyst_real jiles_between(const hyst_jiles_stretch *on, hyst_real target, hyst_real from,
                               hyst_real at_from, hyst_real to, hyst_real at_to)
{
    const hyst_real zero = HYST_REAL(0.0);
    /* Where the last sample was the root has a kink; what is sought lies beyond. */
    if (on->excess > zero && on->sign * (on->x_last - from) > zero &&
        on->sign * (to - on->x_last) > zero) {
        hyst_real slope;
        from = on->x_last;
        at_from = hyst_jiles_sought(on, from, &slope);
    }
    return on->sign < HYST_REAL(0.0) ? hyst_jiles_root(on, target, to, at_to, from, at_from)
                                     : hyst_jiles_root(on, target, from, at_from, to, at_to);
}

/* Beyond the last node. */
static hyst_real jiles_beyond(const hyst_jiles_stretch *on, hyst_real target)
{
    hyst_real way = HYST_REAL(1.0);
    hyst_real slope, x = on->x_node, at = jiles_at_node(on);
    for (size_t left = JILES_DOUBLINGS; left > 0u; --left) {
        x = on->x_node + on->sign * way;
        at = hyst_jiles_sought(on, x, &slope);
        if (on->sign * (at - target) >= HYST_REAL(0.0)) {
            break;
        }
        way = HYST_REAL(2.0) * way;
    }
    return jiles_between(on, target, on->x_node, jiles_at_node(on), x, at);
}

/* A branch towards sign from where the last sample was. */
static void jiles_begin(const hyst_jiles_atherton *model, hyst_jiles_stretch *on, hyst_real sign,
                        hyst_real x, hyst_real m)
{
    const hyst_real reversible = jiles_reversible(model);
    const hyst_real gap = hyst_langevin(x) - m;
    on->sign = sign;
    on->rest = m - reversible * hyst_langevin(x);
    on->x_node = x;
    on->y_node = gap;
    if (sign * gap < HYST_REAL(0.0)) {
        const hyst_real meets = hyst_langevin_inverse(on->rest / (HYST_REAL(1.0) - reversible));
        if (sign * (meets - x) > HYST_REAL(0.0)) {
            on->x_node = meets;
            on->y_node = HYST_REAL(0.0);
        }
    }
}

/* x on the first stretch, which begins at the turn and ends at the node. */
static hyst_real jiles_at_rest(hyst_jiles_stretch *on, hyst_real target, hyst_real x_turn)
{
    hyst_real slope;
    on->rests = 1;
    return jiles_between(on, target, x_turn, hyst_jiles_sought(on, x_turn, &slope), on->x_node,
                         hyst_jiles_sought(on, on->x_node, &slope));
}

/* x where the branch comes to the target; the node goes on to the last one before. */
static hyst_real jiles_solve(hyst_jiles_stretch *on, hyst_real x_turn, hyst_real target)
{
    hyst_jiles_stretch after;
    hyst_real at = jiles_at_node(on);
    if (on->sign * (target - at) < HYST_REAL(0.0) &&
        on->sign * (on->x_node - x_turn) > HYST_REAL(0.0)) {
        return jiles_at_rest(on, target, x_turn);
    }
    while (jiles_next(on, &after)) {
        const hyst_real at_after = jiles_at_node(&after);
        if (on->sign * (target - at_after) < HYST_REAL(0.0)) {
            return jiles_between(on, target, on->x_node, at, after.x_node, at_after);
        }
        *on = after;
        at = at_after;
    }
    return jiles_beyond(on, target);
}

/* What the rate of an output that moved so far takes of the field, over a. */
static hyst_real jiles_losses(const hyst_jiles_atherton *of, hyst_real moved)
{
    const hyst_real zero = HYST_REAL(0.0);
    const hyst_real root = hyst_power(moved < zero ? -moved : moved, HYST_REAL(0.5));
    return of->eddy * moved + (moved < zero ? -of->excess : of->excess) * root;
}

hyst_real hyst_jiles_atherton_step(const hyst_jiles_atherton *model, hyst_real *state,
                                   hyst_real input)
{
    const hyst_real zero = HYST_REAL(0.0), one = HYST_REAL(1.0);
    const int loses = model->eddy > zero || model->excess > zero;
    const hyst_real last = state[HYST_JILES_INPUT];
    const hyst_real sign = input > last ? HYST_REAL(1.0) : HYST_REAL(-1.0);
    const int moves = input > last || input < last;
    const int turns = moves && !(sign * state[HYST_JILES_SIGN] > zero);
    hyst_real x_turn = state[HYST_JILES_X_TURN];
    hyst_jiles_stretch on = {model, 0, state[HYST_JILES_SIGN], state[HYST_JILES_REST],
                             state[HYST_JILES_X_NODE], state[HYST_JILES_Y_NODE],
                             model->inverse ? model->x_share : one + model->eddy * model->x_share,
                             model->inverse ? model->m_share
                                            : model->eddy * model->m_share - model->eta,
                             model->inverse ? zero : model->excess,
                             model->x_share * state[HYST_JILES_X] + model->m_share * state[HYST_JILES_M],
                             state[HYST_JILES_X]};
    if (turns) {
        x_turn = state[HYST_JILES_X];
        jiles_begin(model, &on, sign, x_turn, state[HYST_JILES_M]);
    }
    hyst_real target = input / (model->inverse ? model->level : model->field);
    if (loses && model->inverse == 0) {
        target = target + model->eddy * on.last;
    }
    const int is_beyond = model->inverse && !(on.by_x > zero) &&
                          !(target < HYST_REAL(1.0) && target > HYST_REAL(-1.0));
    if (hyst_is_finite(target) == 0 || is_beyond) {
        return hyst_exp2(HYST_REAL(1e6)); /* an infinity: no field leads there */
    }
    hyst_real x = state[HYST_JILES_X], m = state[HYST_JILES_M];
    if (on.sign > zero || on.sign < zero) {
        x = jiles_solve(&on, x_turn, target);
        m = hyst_jiles_m(&on, x);
    }
    const hyst_real within = model->field * (x - model->eta * m);
    const hyst_real output = model->x_share * x + model->m_share * m;
    const hyst_real answer = model->inverse == 0 ? model->level * output
                             : loses ? within + model->field * jiles_losses(model, output - on.last)
                                     : within;
    if (hyst_is_finite(answer) == 0) {
        return answer;
    }
    state[HYST_JILES_INPUT] = loses && model->inverse == 0 ? within : input;
    state[HYST_JILES_SIGN] = on.sign;
    state[HYST_JILES_X] = x;
    state[HYST_JILES_M] = m;
    state[HYST_JILES_X_TURN] = x_turn;
    state[HYST_JILES_REST] = on.rest;
    state[HYST_JILES_X_NODE] = on.x_node;
    state[HYST_JILES_Y_NODE] = on.y_node;
    return answer;
}

static size_t jiles_atherton_length(const void *model)
{
    (void)model;
    return HYST_JILES_LENGTH;
}

static hyst_real jiles_atherton_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_jiles_atherton_step((const hyst_jiles_atherton *)model, state, u);
}

const hyst_kind hyst_jiles_atherton_kind = {jiles_atherton_length, jiles_atherton_step};
