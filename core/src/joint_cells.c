/* Many plays of fixed radii: a model that is linear in all it estimates, and what is left of it when
 * neighbours are merged. */
#include "hyst/joint_parts.h"
#include "hyst/finite.h"
#include "hyst/play.h"
#include "hyst/ud_factor.h"

#define ZERO HYST_REAL(0.0)
#define ONE HYST_REAL(1.0)

void hyst_cells_start(const hyst_search *search, const hyst_search_layout *at, hyst_real *state)
{
    const size_t count = search->cells + 2u;
    for (size_t j = 0; j < count; ++j) {
        state[at->weight + j] = search->start[j];
        state[at->d + j] = search->limit[j];
    }
    for (size_t j = 0; j < hyst_ud_length(count); ++j) {
        state[at->u + j] = ZERO;
    }
    hyst_real *scalar = state + at->scalars;
    scalar[HYST_SEARCH_NOISE] = search->noise;
    scalar[HYST_SEARCH_SAMPLES] = ZERO;
    scalar[HYST_SEARCH_GROWTH] = ONE;
}

void hyst_cells_follow(const hyst_search *search, const hyst_search_layout *at, hyst_real *state,
                       hyst_real v)
{
    for (size_t i = 0; i < search->cells; ++i) {
        state[at->z + i] = hyst_play(v, search->radius[i], state[at->z + i]);
    }
}

/* Fills psi and returns the predicted output. */
static hyst_real predict(const hyst_search *search, const hyst_search_layout *at,
                         const hyst_real *state, hyst_real v, hyst_real *psi)
{
    const hyst_joint *joint = search->joint;
    const size_t last = search->cells + 1u;
    const hyst_real *weight = state + at->weight;
    const hyst_real *back = state + at->joint.theta + 2u + 2u * joint->plays + joint->front.count;
    hyst_real w = weight[0] * v;
    psi[0] = v;
    for (size_t i = 1; i < last; ++i) {
        psi[i] = state[at->z + i - 1u];
        w += weight[i] * psi[i];
    }
    const hyst_real slope = hyst_joint_map_slope(&joint->back, back, w);
    for (size_t j = 0; j < last; ++j) {
        psi[j] *= slope;
    }
    psi[last] = ONE;
    return hyst_joint_map_at(&joint->back, back, w) + weight[last];
}

void hyst_cells_measure(const hyst_search *search, const hyst_search_layout *at, hyst_real *state,
                        hyst_real v, hyst_real y)
{
    const size_t count = search->cells + 2u;
    hyst_real *psi = state + at->scratch;
    hyst_real *gain = psi + count;
    hyst_real *scalar = state + at->scalars;
    hyst_real *weight = state + at->weight;
    hyst_real *d = state + at->d;
    const hyst_real error = y - predict(search, at, state, v, psi);
    const hyst_real a = hyst_ud_update(count, state + at->u, d, psi, scalar[HYST_SEARCH_NOISE],
                                       gain, gain + count);
    const hyst_real surprise = error * (error / a);
    const hyst_real most = HYST_JOINT_OUTLIER;
    const hyst_real step = error / a * (surprise > most ? most / surprise : ONE);
    hyst_real sum = a + surprise;
    for (size_t j = 0; j < count; ++j) {
        const hyst_real least = search->joint->least_share * search->limit[j];
        weight[j] += step * gain[j];
        d[j] = d[j] > least ? d[j] : least;
        sum += weight[j] + d[j];
    }
    if (!hyst_is_finite(sum)) {
        hyst_cells_start(search, at, state);
        return;
    }
    scalar[HYST_SEARCH_NOISE] = hyst_joint_noise(search->joint, scalar[HYST_SEARCH_NOISE],
                                                 scalar[HYST_SEARCH_SAMPLES], surprise);
    scalar[HYST_SEARCH_SAMPLES] += ONE;
}

void hyst_cells_forget(const hyst_search *search, const hyst_search_layout *at, hyst_real *state)
{
    const size_t count = search->cells + 2u;
    const hyst_real growth = state[at->scalars + HYST_SEARCH_GROWTH];
    hyst_real *variance = state + at->scratch;
    hyst_real *scale = variance + count;
    state[at->scalars + HYST_SEARCH_GROWTH] = ONE;
    if (!(growth > ONE)) {
        return;
    }
    hyst_ud_variances(count, state + at->u, state + at->d, variance);
    for (size_t j = 0; j < count; ++j) {
        scale[j] = variance[j] * growth * growth <= search->limit[j] ? growth : ONE;
    }
    hyst_ud_scale(count, state + at->u, state + at->d, scale);
}

/* What the union of two neighbours loses: the square of the difference it makes to the loading curve,
 * a triangle of height h = w_a w_b / (w_a + w_b) gap over the gap. A weight of 0 or less is what noise
 * leaves beside a larger one, and joins it for nothing. */
static void set_cost(const hyst_search_layout *at, hyst_real *state, size_t k)
{
    const hyst_real *weight = state + at->point_weight;
    const hyst_real *radius = state + at->point_radius;
    const hyst_real gap = radius[k + 1u] - radius[k];
    const hyst_real lighter = weight[k] < weight[k + 1u] ? weight[k] : weight[k + 1u];
    const hyst_real heavier = weight[k] < weight[k + 1u] ? weight[k + 1u] : weight[k];
    const hyst_real height = lighter > ZERO ? lighter / (ONE + lighter / heavier) * gap : ZERO;
    state[at->point_cost + k] = height * height * gap;
}

void hyst_cells_begin_merging(const hyst_search *search, const hyst_search_layout *at,
                              hyst_real *state)
{
    const size_t cells = search->cells;
    for (size_t i = 0; i < cells; ++i) {
        state[at->point_weight + i] = state[at->weight + 1u + i];
        state[at->point_radius + i] = search->radius[i];
    }
    for (size_t i = 0; i + 1u < cells; ++i) {
        set_cost(at, state, i);
    }
    state[at->scalars + HYST_SEARCH_COUNT] = (hyst_real)cells;
}

void hyst_cells_merge(const hyst_search_layout *at, hyst_real *state)
{
    const size_t count = (size_t)state[at->scalars + HYST_SEARCH_COUNT];
    hyst_real *weight = state + at->point_weight;
    hyst_real *radius = state + at->point_radius;
    hyst_real *cost = state + at->point_cost;
    size_t k = 0;
    for (size_t i = 1u; i + 1u < count; ++i) {
        k = cost[i] < cost[k] ? i : k;
    }
    const hyst_real sum = weight[k] + weight[k + 1u];
    const hyst_real share = sum > ZERO ? weight[k + 1u] / sum : HYST_REAL(0.5);
    radius[k] += hyst_clamp(ZERO, ONE, share) * (radius[k + 1u] - radius[k]);
    weight[k] = sum;
    for (size_t i = k + 1u; i + 1u < count; ++i) {
        weight[i] = weight[i + 1u];
        radius[i] = radius[i + 1u];
        cost[i] = cost[i + 1u];
    }
    if (k > 0u) {
        set_cost(at, state, k - 1u);
    }
    if (k + 2u < count) {
        set_cost(at, state, k);
    }
    state[at->scalars + HYST_SEARCH_COUNT] = (hyst_real)(count - 1u);
}
