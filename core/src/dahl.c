/* Dahl's model, one sample at a time. */
#include "hyst/dahl.h"

#include "hyst/branch.h"
#include "hyst/finite.h"
#include "hyst/power.h"
#include "hyst/small_steps.h"

/* 2 to this is no number in any precision. */
#define DAHL_BEYOND HYST_REAL(1e6)

/* z after a way of x >= 0 towards sign. */
static hyst_real dahl_after(hyst_real m, hyst_real z, hyst_real sign, hyst_real x)
{
    const hyst_real one = HYST_REAL(1.0);
    const hyst_real w = one - sign * z;
    if (!(w > HYST_REAL(0.0))) {
        return z; /* the force is at its end */
    }
    const hyst_real t = x * hyst_power(w, m);
    if (!(one + m * t > HYST_REAL(0.0))) {
        return sign; /* n < 1 reaches the end in a finite way */
    }
    /* What w loses, not what is left of it: a small way keeps its digits. */
    const hyst_real after = z - sign * w * hyst_small_exponential(one, -hyst_small_logarithm(m, t));
    return sign * after > one ? sign : after;
}

/* Towards a force of z, from where the branch began: the way, which may be no number. */
static hyst_real dahl_way(hyst_real m, hyst_real from, hyst_real sign, hyst_real z)
{
    const hyst_real left = HYST_REAL(1.0) - sign * z;
    if (!(left > HYST_REAL(0.0))) {
        return hyst_exp2(DAHL_BEYOND); /* an infinity: no way leads there */
    }
    const hyst_real l = hyst_small_logarithm(HYST_REAL(1.0), sign * (z - from) / left);
    return hyst_small_exponential(m, l) / hyst_power(HYST_REAL(1.0) - sign * from, m);
}

hyst_real hyst_dahl_step(const hyst_dahl *model, hyst_real *state, hyst_real input)
{
    const hyst_real zero = HYST_REAL(0.0);
    const hyst_real value = model->inverse ? input / model->force : input;
    /* The input turns, be it the position or the force. */
    const hyst_real last = model->inverse ? state[HYST_BRANCH_Z] : state[HYST_BRANCH_U];
    const hyst_real began = model->inverse ? state[HYST_BRANCH_Z_TURN] : state[HYST_BRANCH_U_TURN];
    hyst_real u_turn = state[HYST_BRANCH_U_TURN];
    hyst_real z_turn = state[HYST_BRANCH_Z_TURN];
    if (hyst_branch_turns(began, last, value) != 0) {
        u_turn = state[HYST_BRANCH_U];
        z_turn = state[HYST_BRANCH_Z];
    }
    const hyst_real way = value - (model->inverse ? z_turn : u_turn);
    const hyst_real sign = way < zero ? HYST_REAL(-1.0) : HYST_REAL(1.0);
    hyst_real u = value;
    hyst_real z = value;
    if (model->inverse != 0) {
        u = u_turn + sign * dahl_way(model->excess, z_turn, sign, z) / model->rate;
        if (hyst_is_finite(u) == 0) {
            return u; /* a force that nothing reaches leaves the memory as it is */
        }
    } else {
        z = dahl_after(model->excess, z_turn, sign, model->rate * (sign * way));
    }
    state[HYST_BRANCH_U] = u;
    state[HYST_BRANCH_Z] = z;
    state[HYST_BRANCH_U_TURN] = u_turn;
    state[HYST_BRANCH_Z_TURN] = z_turn;
    return model->inverse ? u : model->force * z;
}

static size_t dahl_length(const void *model)
{
    (void)model;
    return HYST_BRANCH_LENGTH;
}

static hyst_real dahl_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_dahl_step((const hyst_dahl *)model, state, u);
}

const hyst_kind hyst_dahl_kind = {dahl_length, dahl_step};
