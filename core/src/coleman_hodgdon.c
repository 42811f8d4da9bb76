/* The hysteresis of Coleman and Hodgdon, one sample at a time.
 *
 * A branch is walked towards growing v = s u, in which f and g are the same: they are odd and even. */
#include "hyst/coleman_hodgdon.h"

#include "hyst/branch.h"
#include "hyst/finite.h"

/* A place on a branch, mirrored where it falls: v = s u and what s y is beyond f(v). */
typedef struct {
    hyst_real v;
    hyst_real beyond;
} coleman_place;

/* Ends of pieces in the order in which v passes them: first the negative ones, outermost first. */
static hyst_real coleman_end(const hyst_coleman_hodgdon *model, size_t index)
{
    const size_t knots = model->count - 1u;
    return index < knots ? -model->knot[knots - 1u - index] : model->knot[index - knots];
}

/* Which slopes hold before the end of this index. */
static size_t coleman_slopes(const hyst_coleman_hodgdon *model, size_t index)
{
    const size_t knots = model->count - 1u;
    return index < knots ? knots - index : index - knots;
}

static size_t coleman_piece_after(const hyst_coleman_hodgdon *model, hyst_real v)
{
    const size_t ends = 2u * (model->count - 1u);
    size_t index = 0;
    while (index < ends && coleman_end(model, index) <= v) {
        ++index;
    }
    return index;
}

static hyst_real coleman_f(const hyst_coleman_hodgdon *model, hyst_real v)
{
    const hyst_real size = v < HYST_REAL(0.0) ? -v : v;
    hyst_real sum = HYST_REAL(0.0), from = HYST_REAL(0.0);
    size_t piece = 0;
    while (piece + 1u < model->count && model->knot[piece] < size) {
        sum = sum + model->a[piece] * (model->knot[piece] - from);
        from = model->knot[piece];
        ++piece;
    }
    sum = sum + model->a[piece] * (size - from);
    return v < HYST_REAL(0.0) ? -sum : sum;
}

/* What `beyond` still has to change by before it rests, in the piece of these slopes. */
static hyst_real coleman_to_rest(const hyst_coleman_hodgdon *model, size_t slopes, hyst_real beyond)
{
    return (model->b[slopes] - model->a[slopes]) / model->alpha - beyond;
}

static hyst_real coleman_relaxed(const hyst_coleman_hodgdon *model, size_t slopes,
                                 coleman_place from, hyst_real v)
{
    const hyst_real rest = coleman_to_rest(model, slopes, from.beyond);
    return from.beyond + rest * hyst_coleman_share(model->alpha * (v - from.v));
}

/* s y where the branch comes to v. */
static hyst_real coleman_forward(const hyst_coleman_hodgdon *model, coleman_place at, hyst_real v)
{
    const size_t ends = 2u * (model->count - 1u);
    size_t index = coleman_piece_after(model, at.v);
    while (index < ends && coleman_end(model, index) < v) {
        const hyst_real end = coleman_end(model, index);
        at.beyond = coleman_relaxed(model, coleman_slopes(model, index), at, end);
        at.v = end;
        ++index;
    }
    return coleman_f(model, v) + coleman_relaxed(model, coleman_slopes(model, index), at, v);
}

/* v where the branch comes to s y = target. */
static hyst_real coleman_back(const hyst_coleman_hodgdon *model, coleman_place at, hyst_real target)
{
    const size_t ends = 2u * (model->count - 1u);
    size_t index = coleman_piece_after(model, at.v);
    while (index < ends) {
        const hyst_real end = coleman_end(model, index);
        const hyst_real beyond = coleman_relaxed(model, coleman_slopes(model, index), at, end);
        if (!(coleman_f(model, end) + beyond < target)) {
            break;
        }
        at.beyond = beyond;
        at.v = end;
        ++index;
    }
    const size_t slopes = coleman_slopes(model, index);
    const hyst_real way = target - (coleman_f(model, at.v) + at.beyond);
    return at.v + hyst_coleman_way(model->a[slopes] / model->alpha,
                                   coleman_to_rest(model, slopes, at.beyond), way) /
                      model->alpha;
}

hyst_real hyst_coleman_hodgdon_step(const hyst_coleman_hodgdon *model, hyst_real *state,
                                    hyst_real input)
{
    const hyst_real last = model->inverse ? state[HYST_BRANCH_Z] : state[HYST_BRANCH_U];
    const hyst_real began = model->inverse ? state[HYST_BRANCH_Z_TURN] : state[HYST_BRANCH_U_TURN];
    hyst_real u_turn = state[HYST_BRANCH_U_TURN];
    hyst_real y_turn = state[HYST_BRANCH_Z_TURN];
    if (hyst_branch_turns(began, last, input)) {
        u_turn = state[HYST_BRANCH_U];
        y_turn = state[HYST_BRANCH_Z];
    }
    const int falls = model->inverse ? input < y_turn : input < u_turn;
    const hyst_real sign = falls ? HYST_REAL(-1.0) : HYST_REAL(1.0);
    const coleman_place turn = {sign * u_turn,
                                sign * y_turn - coleman_f(model, sign * u_turn)};
    const hyst_real answer = sign * (model->inverse ? coleman_back(model, turn, sign * input)
                                                    : coleman_forward(model, turn, sign * input));
    if (hyst_is_finite(answer) == 0) {
        return answer; /* the memory stays as it is */
    }
    state[HYST_BRANCH_U] = model->inverse ? answer : input;
    state[HYST_BRANCH_Z] = model->inverse ? input : answer;
    state[HYST_BRANCH_U_TURN] = u_turn;
    state[HYST_BRANCH_Z_TURN] = y_turn;
    return answer;
}

static size_t coleman_hodgdon_length(const void *model)
{
    (void)model;
    return HYST_BRANCH_LENGTH;
}

static hyst_real coleman_hodgdon_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_coleman_hodgdon_step((const hyst_coleman_hodgdon *)model, state, u);
}

const hyst_kind hyst_coleman_hodgdon_kind = {coleman_hodgdon_length, coleman_hodgdon_step};
