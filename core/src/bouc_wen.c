/* Bouc-Wen's model, one sample at a time. */
#include "hyst/bouc_wen.h"

#include "hyst/bouc_wen_branch.h"
#include "hyst/branch.h"
#include "hyst/finite.h"
#include "hyst/power.h"

/* Of the inverse, behind those of a branch. */
#define BOUC_WEN_Y 4u
#define BOUC_WEN_Y_TURN 5u
#define BOUC_WEN_INVERSE_LENGTH 6u

/* The share after a way from another one. */
static hyst_real bouc_wen_share(const hyst_bouc_wen *model, const hyst_bouc_wen_side *side,
                                hyst_real tilt, hyst_real from, hyst_real way)
{
    const hyst_real n = model->exponent;
    if (from < HYST_REAL(0.0)) {
        const hyst_real to_zero = hyst_bouc_wen_falling(n, side->ratio, -from) - tilt * from;
        if (way < to_zero) {
            return -hyst_bouc_wen_fallen(n, side->ratio, tilt, -from, way);
        }
        return hyst_bouc_wen_risen(n, model->join, tilt, HYST_REAL(0.0), way - to_zero);
    }
    return hyst_bouc_wen_risen(n, model->join, tilt, from, way);
}

/* The way from 0 to a share of either sign. */
static hyst_real bouc_wen_way(const hyst_bouc_wen *model, const hyst_bouc_wen_side *side,
                              hyst_real share)
{
    if (share < HYST_REAL(0.0)) {
        return -hyst_bouc_wen_falling(model->exponent, side->ratio, -share);
    }
    return hyst_bouc_wen_rising(model->exponent, model->join, share);
}

/* What u moves by while y does by dy > 0 and the share goes from one to another. */
static hyst_real bouc_wen_back(const hyst_bouc_wen *model, const hyst_bouc_wen_side *side,
                               hyst_real from, hyst_real to, hyst_real dy)
{
    const hyst_real moved = side->limit * (to - from);
    const hyst_real slope = HYST_REAL(1.0) - hyst_power(to, model->exponent);
    /* Where z follows the input more than y does, the way to the share has the better digits. */
    if (to < HYST_REAL(1.0) && side->limit * side->rate * slope > model->stiffness) {
        return (bouc_wen_way(model, side, to) - bouc_wen_way(model, side, from)) / side->rate;
    }
    return (dy - model->share * moved) / model->stiffness;
}

typedef struct {
    hyst_real u, z;
} bouc_wen_point;

/* Where the model is after its input moved by gone towards sign. */
static bouc_wen_point bouc_wen_along(const hyst_bouc_wen *model, const hyst_bouc_wen_side *side,
                                     bouc_wen_point turn, hyst_real sign, hyst_real gone)
{
    const hyst_real from = sign * turn.z / side->limit;
    bouc_wen_point to;
    if (model->inverse != 0) {
        const hyst_real tilt = model->share * side->limit * side->rate / model->stiffness;
        const hyst_real way = side->rate * gone / model->stiffness;
        const hyst_real share = bouc_wen_share(model, side, tilt, from, way);
        to.u = turn.u + sign * bouc_wen_back(model, side, from, share, gone);
        to.z = sign * side->limit * share;
    } else {
        to.u = turn.u + sign * gone;
        to.z = sign * side->limit *
               bouc_wen_share(model, side, HYST_REAL(0.0), from, side->rate * gone);
    }
    return to;
}

/* A rest where a branch begins: what is there, and which way it would go on for a derivative. */
static bouc_wen_point bouc_wen_at_rest(const hyst_bouc_wen *model, bouc_wen_point turn,
                                       hyst_real nothing)
{
    const hyst_bouc_wen_side *side = &model->up;
    const hyst_real share = turn.z / side->limit;
    const hyst_real held = share < HYST_REAL(0.0)
                               ? -side->ratio * hyst_power(-share, model->exponent)
                               : hyst_power(share, model->exponent);
    const hyst_real slope = side->limit * side->rate * (HYST_REAL(1.0) - held);
    bouc_wen_point to;
    to.u = nothing;
    if (model->inverse != 0) {
        to.u = nothing / (model->stiffness + model->share * slope);
    }
    to.z = turn.z + slope * to.u;
    to.u = turn.u + to.u;
    return to;
}

hyst_real hyst_bouc_wen_step(const hyst_bouc_wen *model, hyst_real *state, hyst_real input)
{
    const hyst_real one = HYST_REAL(1.0);
    const size_t last = model->inverse ? BOUC_WEN_Y : HYST_BRANCH_U;
    const size_t began = model->inverse ? BOUC_WEN_Y_TURN : HYST_BRANCH_U_TURN;
    hyst_real turn = state[began];
    bouc_wen_point from;
    from.u = state[HYST_BRANCH_U_TURN];
    from.z = state[HYST_BRANCH_Z_TURN];
    if (hyst_branch_turns(turn, state[last], input) != 0) {
        from.u = state[HYST_BRANCH_U];
        from.z = state[HYST_BRANCH_Z];
        turn = state[last];
    }
    /* What y was follows from u and z; the state's tells a rest by its bits. */
    const hyst_real origin =
        model->inverse ? model->stiffness * from.u + model->share * from.z : from.u;
    bouc_wen_point to;
    if (input < turn) {
        to = bouc_wen_along(model, &model->down, from, -one, origin - input);
    } else if (input > turn) {
        to = bouc_wen_along(model, &model->up, from, one, input - origin);
    } else {
        to = bouc_wen_at_rest(model, from, input - origin);
    }
    if (model->inverse == 0) {
        to.u = input;
    }
    const hyst_real y = model->stiffness * to.u + model->share * to.z;
    if (hyst_is_finite(y) == 0) {
        return y;
    }
    state[HYST_BRANCH_U] = to.u;
    state[HYST_BRANCH_Z] = to.z;
    state[HYST_BRANCH_U_TURN] = from.u;
    state[HYST_BRANCH_Z_TURN] = from.z;
    if (model->inverse != 0) {
        state[BOUC_WEN_Y] = input;
        state[BOUC_WEN_Y_TURN] = turn;
        return to.u;
    }
    return y;
}

static size_t bouc_wen_length(const void *model)
{
    const hyst_bouc_wen *of = (const hyst_bouc_wen *)model;
    return of->inverse ? BOUC_WEN_INVERSE_LENGTH : HYST_BRANCH_LENGTH;
}

static hyst_real bouc_wen_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_bouc_wen_step((const hyst_bouc_wen *)model, state, u);
}

const hyst_kind hyst_bouc_wen_kind = {bouc_wen_length, bouc_wen_step};
