/* Plays whose outputs creep, one sample at a time. */
#include "hyst/creeping_plays.h"

#include "hyst/bank.h"
#include "hyst/finite.h"

/* The sum of what all lags answer. */
static hyst_real crept_of_plays(const hyst_creeping_plays *model, const hyst_real *lag)
{
    hyst_real crept = HYST_REAL(0.0);
    for (size_t i = 0; i < model->plays.count * model->lags; ++i) {
        crept += model->weight[i] * lag[2u * i];
    }
    return crept;
}

/* What a bank will answer, its plays left where they are; summed in the bank's order. */
static hyst_real answer_of_plays(const hyst_pi *pi, const hyst_real *z, hyst_real u)
{
    const size_t fours = pi->count >= HYST_WIDE_BANK ? pi->count - pi->count % 4u : 0u;
    hyst_real y = pi->p0 * u;
    size_t i = 0;
    if (fours > 0u) {
        const hyst_real zero = HYST_REAL(0.0);
        hyst_real sum[4] = {zero, zero, zero, zero};
        for (; i < fours; ++i) {
            sum[i % 4u] += pi->p[i] * hyst_play(u, pi->r[i], z[i]);
        }
        y += (sum[0] + sum[2]) + (sum[1] + sum[3]);
    }
    for (; i < pi->count; ++i) {
        y += pi->p[i] * hyst_play(u, pi->r[i], z[i]);
    }
    return y;
}

static void follow_plays(const hyst_creeping_plays *model, const hyst_real *z, hyst_real *lag)
{
    for (size_t i = 0; i < model->plays.count; ++i) {
        for (size_t j = 0; j < model->lags; ++j) {
            const hyst_real step = model->gain[j] * (z[i] - lag[0]) + lag[1];
            const hyst_real next = lag[0] + step;
            lag[1] = step - (next - lag[0]);
            lag[0] = next;
            lag += 2;
        }
    }
}

hyst_real hyst_creeping_plays_step(const hyst_creeping_plays *model, hyst_real *state,
                                   hyst_real input)
{
    hyst_real *z = state;
    hyst_real *back = z + model->plays.count;
    hyst_real *lag = back + model->back.count;
    const hyst_real crept = crept_of_plays(model, lag);
    const hyst_real left = model->inverse != 0 ? input - crept : input;
    const hyst_real u = model->inverse != 0 ? answer_of_plays(&model->back, back, left) : input;
    const hyst_real output = model->inverse != 0 ? u : answer_of_plays(&model->plays, z, u) + crept;
    const hyst_real zero = (u - u) + (output - output); /* unless one is not finite: then NaN */
    if (hyst_is_finite(zero) == 0) {
        return zero;
    }
    if (model->inverse != 0) {
        (void)hyst_pi_step(&model->back, back, left);
    }
    (void)hyst_pi_step(&model->plays, z, u);
    follow_plays(model, z, lag);
    return output;
}

static size_t creeping_plays_length(const void *of)
{
    const hyst_creeping_plays *model = (const hyst_creeping_plays *)of;
    return model->plays.count * (1u + 2u * model->lags) + model->back.count;
}

static hyst_real creeping_plays_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_creeping_plays_step((const hyst_creeping_plays *)model, state, u);
}

const hyst_kind hyst_creeping_plays_kind = {creeping_plays_length, creeping_plays_step};
