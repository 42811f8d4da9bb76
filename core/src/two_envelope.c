/* Generalized plays between two envelopes, one sample at a time. */
#include "hyst/two_envelope.h"

#include "hyst/bank.h"
#include "hyst/finite.h"

/* Equal envelopes give their value itself. */
static hyst_real mean_of_envelopes(hyst_real up, hyst_real down)
{
    return HYST_REAL(0.5) * (up + down);
}

static hyst_real two_envelope_forward(const hyst_two_envelope *model, hyst_real *z, hyst_real u)
{
    const hyst_real up = hyst_dead_zone_step(&model->up, u);
    const hyst_real down = hyst_dead_zone_step(&model->down, u);
    const hyst_pi plays = {model->count, model->p0, model->p, model->r};
    return hyst_bank_step(&plays, z, up, down, plays.p0 * mean_of_envelopes(up, down));
}

/* Where a play goes on the way up from the last u, or on the way down. */
static hyst_real pushed(int rising, hyst_real edge, hyst_real z)
{
    const int moves = rising ? edge > z : edge < z;
    return HYST_SELECT(moves, edge, z);
}

/* The output at u on the branch that leaves the state, which stays as it is. */
static hyst_real two_envelope_branch(const hyst_two_envelope *model, const hyst_real *z, int rising,
                                     hyst_real u)
{
    const hyst_real up = hyst_dead_zone_step(&model->up, u);
    const hyst_real down = hyst_dead_zone_step(&model->down, u);
    hyst_real y = model->p0 * mean_of_envelopes(up, down);
    for (size_t i = 0; i < model->count; ++i) {
        const hyst_real edge = rising ? up - model->r[i] : down + model->r[i];
        y += model->p[i] * pushed(rising, edge, z[i]);
    }
    return y;
}

/* Knots at which the branch is below the output: the solution lies between the last of them and the
 * next one. */
static size_t knots_below(const hyst_two_envelope *model, const hyst_real *z, int rising, hyst_real y)
{
    size_t low = 0, high = model->knots;
    while (low < high) {
        const size_t middle = low + (high - low) / 2u;
        if (two_envelope_branch(model, z, rising, model->knot[middle]) < y) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

/* The slope of an envelope between the last of `below` knots and the next one. */
static hyst_real envelope_slope(const hyst_two_envelope *model, const hyst_dead_zone *map, size_t below)
{
    hyst_real slope = HYST_REAL(0.0);
    for (size_t i = 0; i < map->count; ++i) {
        const hyst_real rho = map->threshold[i];
        int counts = 1;
        if (rho > HYST_REAL(0.0)) {
            counts = below > 0u && model->knot[below - 1u] >= rho;
        } else if (rho < HYST_REAL(0.0)) {
            counts = below < model->knots && model->knot[below] <= rho;
        }
        if (counts) {
            slope += map->weight[i];
        }
    }
    return slope;
}

/* The u of an output on a branch, and the slope of the output there.
 *
 * From an anchor, the knot before u, the output is y_0 + slope (u - anchor), first with no play
 * moving. Each play that is passed before the output is reached adds its share to both. */
static hyst_real solve_two_envelope(const hyst_two_envelope *model, const hyst_real *z, int rising,
                                    hyst_real y, hyst_real *slope)
{
    const size_t below = knots_below(model, z, rising, y);
    const hyst_real anchor = model->knot[below > 0u ? below - 1u : 0u];
    const hyst_real up = hyst_dead_zone_step(&model->up, anchor);
    const hyst_real down = hyst_dead_zone_step(&model->down, anchor);
    const hyst_real up_slope = envelope_slope(model, &model->up, below);
    const hyst_real down_slope = envelope_slope(model, &model->down, below);
    const hyst_real pushing = rising ? up : down;
    const hyst_real pushing_slope = rising ? up_slope : down_slope;
    hyst_real left = y - model->p0 * mean_of_envelopes(up, down);
    hyst_real sum = model->p0 * mean_of_envelopes(up_slope, down_slope);
    hyst_real way;
    for (size_t i = 0; i < model->count; ++i) {
        left -= model->p[i] * z[i];
    }
    way = left / sum;
    for (size_t i = 0; i < model->count; ++i) {
        const hyst_real edge = rising ? pushing - model->r[i] : pushing + model->r[i];
        const hyst_real reached = edge + pushing_slope * way;
        if (rising ? reached > z[i] : reached < z[i]) {
            left -= model->p[i] * (edge - z[i]);
            sum += model->p[i] * pushing_slope;
            way = left / sum;
        }
    }
    *slope = sum;
    return anchor + way;
}

static hyst_real two_envelope_inverse(const hyst_two_envelope *model, hyst_real *state, hyst_real y)
{
    hyst_real *last = state + model->count; /* u, y, slope */
    const int rising = y > last[1];
    hyst_real slope, u;
    if (y <= last[1] && y >= last[1]) {
        /* A rest: u itself; the rest of the sum is for numbers that carry derivatives. */
        return last[0] + (y - last[1]) / last[2];
    }
    u = solve_two_envelope(model, state, rising, y, &slope);
    /* Rounding must not move the output against the input. */
    if (rising ? u < last[0] : u > last[0]) {
        u = last[0];
    }
    if (!hyst_is_finite(u)) {
        return u;
    }
    (void)two_envelope_forward(model, state, u);
    last[0] = u;
    last[1] = y;
    last[2] = slope;
    return u;
}

hyst_real hyst_two_envelope_step(const hyst_two_envelope *model, hyst_real *state, hyst_real input)
{
    return model->inverse ? two_envelope_inverse(model, state, input)
                          : two_envelope_forward(model, state, input);
}

static size_t two_envelope_length(const void *model)
{
    const hyst_two_envelope *of = (const hyst_two_envelope *)model;
    return of->inverse ? of->count + 3u : of->count;
}

static hyst_real two_envelope_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_two_envelope_step((const hyst_two_envelope *)model, state, u);
}

const hyst_kind hyst_two_envelope_kind = {two_envelope_length, two_envelope_step};
