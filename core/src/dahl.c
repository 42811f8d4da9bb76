/* Dahl's model, one sample at a time. */
#include "hyst/dahl.h"

#include "hyst/power.h"

/* Below this size of v the logarithm of 1 + v is summed, since 1 + v has lost digits of v. */
#define DAHL_SMALL HYST_REAL(0.25)
/* 2 to this is no number in any precision. */
#define DAHL_BEYOND HYST_REAL(1e6)
#define DAHL_LN2 HYST_REAL(0.6931471805599453)
#define DAHL_LOG2_E HYST_REAL(1.4426950408889634)

/* ln(1 + m t) / m, and its limit t where m is 0; v = m t > -1. */
static hyst_real dahl_logarithm(hyst_real m, hyst_real t)
{
    const hyst_real v = m * t;
    if (v < DAHL_SMALL && v > -DAHL_SMALL) {
        /* 2 artanh(q) / m with q = v / (2 + v), the m taken out before it can divide. */
        const hyst_real q = v / (HYST_REAL(2.0) + v);
        const hyst_real s = q * q;
        hyst_real sum = HYST_REAL(0.0);
        for (size_t k = 10; k > 0u; --k) {
            sum = (sum + HYST_REAL(1.0) / (hyst_real)(2u * k + 1u)) * s;
        }
        return HYST_REAL(2.0) * t / (HYST_REAL(2.0) + v) * (HYST_REAL(1.0) + sum);
    }
    return DAHL_LN2 * hyst_log2(HYST_REAL(1.0) + v) / m;
}

/* (exp(m l) - 1) / m, and its limit l where m is 0. */
static hyst_real dahl_exponential(hyst_real m, hyst_real l)
{
    const hyst_real v = m * l;
    if (v < DAHL_SMALL && v > -DAHL_SMALL) {
        hyst_real sum = HYST_REAL(1.0);
        for (size_t k = 13; k > 1u; --k) {
            sum = HYST_REAL(1.0) + sum * v / (hyst_real)k;
        }
        return l * sum;
    }
    return (hyst_exp2(DAHL_LOG2_E * v) - HYST_REAL(1.0)) / m;
}

/* w after a way of x > 0. */
static hyst_real dahl_after(hyst_real m, hyst_real w, hyst_real x)
{
    if (!(w > HYST_REAL(0.0))) {
        return w; /* the force is at its end */
    }
    const hyst_real t = x * hyst_power(w, m);
    if (!(HYST_REAL(1.0) + m * t > HYST_REAL(0.0))) {
        return HYST_REAL(0.0); /* n < 1 reaches the end in a finite way */
    }
    return w * hyst_exp2(-DAHL_LOG2_E * dahl_logarithm(m, t));
}

hyst_real hyst_dahl_step(const hyst_dahl *model, hyst_real *state, hyst_real input)
{
    const hyst_real zero = HYST_REAL(0.0);
    const hyst_real one = HYST_REAL(1.0);
    const hyst_real z = state[1];
    const hyst_real target = input / model->force;
    const hyst_real change = model->inverse ? target - z : input - state[0];
    if (!(change > zero || change < zero)) {
        return model->inverse ? state[0] : model->force * z;
    }
    const hyst_real sign = change > zero ? one : -one;
    const hyst_real w = one - sign * z;
    if (!model->inverse) {
        const hyst_real size = sign * change;
        state[0] = input;
        state[1] = sign * (one - dahl_after(model->excess, w, model->rate * size));
        return model->force * state[1];
    }
    const hyst_real w_next = one - sign * target;
    if (!(w_next > zero)) {
        return sign * hyst_exp2(DAHL_BEYOND); /* an infinity: no way leads there */
    }
    const hyst_real l = DAHL_LN2 * hyst_log2(w / w_next);
    const hyst_real way = dahl_exponential(model->excess, l) / hyst_power(w, model->excess);
    state[0] += sign * way / model->rate;
    state[1] = target;
    return state[0];
}

static size_t dahl_length(const void *model)
{
    (void)model;
    return 2;
}

static hyst_real dahl_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_dahl_step((const hyst_dahl *)model, state, u);
}

const hyst_kind hyst_dahl_kind = {dahl_length, dahl_step};
