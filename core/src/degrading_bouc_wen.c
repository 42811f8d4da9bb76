/* Bouc-Wen's model that degrades and pinches, one sample at a time. */
#include "hyst/degrading_bouc_wen.h"

#include "hyst/branch.h"
#include "hyst/finite.h"
#include "hyst/power.h"

#define DEGRADING_LENGTH 7u
#define DEGRADING_INVERSE_LENGTH 9u

/* Places in the state. */
enum {
    DEGRADING_U,
    DEGRADING_Z,
    DEGRADING_E,
    DEGRADING_U_TURN,
    DEGRADING_WAY_NODE,
    DEGRADING_Z_NODE,
    DEGRADING_E_NODE,
    DEGRADING_Y, /* this and the next in the inverse alone */
    DEGRADING_Y_TURN
};

/* Along a branch: the last node, how far it is from the turn, and how far the sample is from it. */
typedef struct {
    hyst_real sign, u_turn, way, beyond;
    hyst_degrading_point node, at;
} degrading_place;

/* y at the node, over the limit of z, in the direction of the branch. */
static hyst_real degrading_y(const hyst_degrading_bouc_wen *model, const degrading_place *on)
{
    const hyst_real u = on->u_turn + on->sign * on->way / model->rate;
    return on->sign * model->stiffness * u / model->limit + on->node.share;
}

/* How far the input is from the node, in what it is measured by: way, or y. */
static hyst_real degrading_left(const hyst_degrading_bouc_wen *model, const degrading_place *on,
                                hyst_real input)
{
    if (model->inverse != 0) {
        return on->sign * input / model->limit - degrading_y(model, on);
    }
    return on->sign * (input - on->u_turn) * model->rate - on->way;
}

/* From node to node to where the input is; 0 where that is too far. */
static int degrading_follow(const hyst_degrading_bouc_wen *model, degrading_place *on,
                            hyst_real input)
{
    const hyst_real by_way = model->stiffness / (model->limit * model->rate);
    for (size_t count = HYST_DEGRADING_MOST; count > 0u; --count) {
        hyst_degrading_point next;
        const hyst_real way = hyst_degrading_next(&model->loop, on->node, &next);
        const hyst_real left = degrading_left(model, on, input);
        const hyst_real moved =
            model->inverse != 0 ? by_way * way + (next.share - on->node.share) : way;
        if (!(left > moved)) {
            on->beyond = left;
            if (model->inverse != 0) {
                on->beyond = hyst_degrading_root(&model->loop, on->node, by_way,
                                                 left + on->node.share, way);
            }
            on->at = hyst_degrading_advance(&model->loop, on->node, on->beyond);
            return 1;
        }
        on->node = next;
        on->way = on->way + way;
    }
    return 0;
}

/* A rest where a branch begins: what is there, and which way it would go on for a derivative. */
static hyst_real degrading_rest(const hyst_degrading_bouc_wen *model, degrading_place *on,
                                hyst_real input)
{
    const hyst_degrading_point slope = hyst_degrading_slope(&model->loop, on->node);
    const hyst_real by_way = model->stiffness / (model->limit * model->rate);
    const hyst_real left = degrading_left(model, on, input);
    on->beyond = model->inverse != 0 ? left / (by_way + slope.share) : left;
    on->at.share = on->node.share + on->beyond * slope.share;
    on->at.energy = on->node.energy + on->beyond * slope.energy;
    return on->u_turn + on->beyond / model->rate;
}

static void degrading_keep(hyst_real *state, const degrading_place *on, hyst_real u)
{
    state[DEGRADING_U] = u;
    state[DEGRADING_Z] = on->sign * on->at.share;
    state[DEGRADING_E] = on->at.energy;
    state[DEGRADING_U_TURN] = on->u_turn;
    state[DEGRADING_WAY_NODE] = on->way;
    state[DEGRADING_Z_NODE] = on->sign * on->node.share;
    state[DEGRADING_E_NODE] = on->node.energy;
}

hyst_real hyst_degrading_bouc_wen_step(const hyst_degrading_bouc_wen *model, hyst_real *state,
                                       hyst_real input)
{
    const hyst_real one = HYST_REAL(1.0), zero = HYST_REAL(0.0);
    const size_t last = model->inverse ? (size_t)DEGRADING_Y : (size_t)DEGRADING_U;
    hyst_real turn = state[model->inverse ? (size_t)DEGRADING_Y_TURN : (size_t)DEGRADING_U_TURN];
    const int turns = hyst_branch_turns(turn, state[last], input);
    if (turns != 0) {
        turn = state[last];
    }
    degrading_place on;
    on.sign = input < turn ? -one : one;
    on.u_turn = turns ? state[DEGRADING_U] : state[DEGRADING_U_TURN];
    on.way = turns ? zero : state[DEGRADING_WAY_NODE];
    on.node.share = on.sign * state[turns ? DEGRADING_Z : DEGRADING_Z_NODE];
    on.node.energy = state[turns ? DEGRADING_E : DEGRADING_E_NODE];
    on.at = on.node;
    on.beyond = zero;
    if (hyst_is_finite(input) == 0) {
        return input;
    }
    hyst_real u;
    if (input < turn || input > turn) {
        if (degrading_follow(model, &on, input) == 0) {
            return hyst_exp2(HYST_REAL(1e6)); /* an infinity: too far for one sample */
        }
        u = on.u_turn + on.sign * ((on.way + on.beyond) / model->rate);
    } else {
        u = degrading_rest(model, &on, input);
    }
    if (model->inverse == 0) {
        u = input;
    }
    const hyst_real y = model->stiffness * u + on.sign * model->limit * on.at.share;
    if (hyst_is_finite(y) == 0) {
        return y;
    }
    degrading_keep(state, &on, u);
    if (model->inverse != 0) {
        state[DEGRADING_Y] = input;
        state[DEGRADING_Y_TURN] = turn;
        return u;
    }
    return y;
}

static size_t degrading_bouc_wen_length(const void *model)
{
    const hyst_degrading_bouc_wen *of = (const hyst_degrading_bouc_wen *)model;
    return of->inverse != 0 ? DEGRADING_INVERSE_LENGTH : DEGRADING_LENGTH;
}

static hyst_real degrading_bouc_wen_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_degrading_bouc_wen_step((const hyst_degrading_bouc_wen *)model, state, u);
}

const hyst_kind hyst_degrading_bouc_wen_kind = {degrading_bouc_wen_length, degrading_bouc_wen_step};
