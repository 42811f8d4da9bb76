/* The joint estimator and a search for a better minimum beside it: one sample. */
#include "hyst/joint_search.h"

#include "hyst/finite.h"
#include "hyst/joint_parts.h"
#include "hyst/play.h"
#include "hyst/ud_factor.h"

#define ZERO HYST_REAL(0.0)
#define ONE HYST_REAL(1.0)
#define GATHERING HYST_REAL(0.0)
#define MERGING HYST_REAL(1.0)
#define ON_TRIAL HYST_REAL(2.0)

/* Turns after which enough is known of the cells, and after which an undecided trial ends. */
#define TURNS_TO_GATHER HYST_REAL(2.0)
#define TURNS_OF_TRIAL HYST_REAL(20.0)
/* Standard errors by which a rival must be better, and at which a worse one is given up. */
#define BETTER HYST_REAL(3.0)
#define WORSE HYST_REAL(-2.0)
/* Correlation of a rival's successive errors from which on they are no noise, so that standard
 * errors mean nothing; it then must leave less than this share of the estimate's squares. */
#define NO_NOISE HYST_REAL(0.5)
#define CLEAR_SHARE HYST_REAL(0.25)
/* How far off a rival is believed to be, as shares of the gaps between its radii and of its weights:
 * merging finds radii better than weights. */
#define RIVAL_SPREAD HYST_REAL(0.15)
#define RIVAL_WEIGHT_SPREAD HYST_REAL(0.4)
/* Of the standard errors of the cells between two turns; more is never needed. */
#define MOST_GROWTH HYST_REAL(1e6)

hyst_search_layout hyst_search_places(const hyst_search *search)
{
    hyst_search_layout at;
    const size_t cells = search->cells;
    const size_t count = cells > 0u ? cells + 2u : 0u;
    at.joint = hyst_joint_places(search->joint);
    at.scalars = at.joint.length;
    at.rival = at.scalars + HYST_SEARCH_SCALARS;
    at.weight = at.rival + (cells > 0u ? at.joint.length : 0u);
    at.d = at.weight + count;
    at.u = at.d + count;
    at.z = at.u + (count > 0u ? hyst_ud_length(count) : 0u);
    at.point_weight = at.z + cells;
    at.point_radius = at.point_weight + cells;
    at.point_cost = at.point_radius + cells;
    at.scratch = at.point_cost + cells;
    at.length = at.scratch + 3u * count;
    return at;
}

static void enter(hyst_real *scalar, hyst_real stage)
{
    scalar[HYST_SEARCH_STAGE] = stage;
    scalar[HYST_SEARCH_TURNS] = ZERO;
}

static hyst_real front_at(const hyst_search *search, const hyst_search_layout *at,
                          const hyst_real *state, hyst_real u)
{
    const hyst_joint *joint = search->joint;
    return hyst_joint_map_at(&joint->front, state + at->joint.theta + 2u + 2u * joint->plays, u);
}

void hyst_search_start(const hyst_search *search, hyst_real *state)
{
    const hyst_search_layout at = hyst_search_places(search);
    for (size_t i = at.scalars; i < at.length; ++i) {
        state[i] = ZERO;
    }
    if (search->cells > 0u) {
        hyst_cells_start(search, &at, state);
    }
}

/* Follows the input from turn to turn; 1 where it has turned. */
static int turns(const hyst_search *search, const hyst_search_layout *at, hyst_real *state,
                 hyst_real u, hyst_real v)
{
    hyst_real *scalar = state + at->scalars;
    const hyst_real low = state[HYST_JOINT_LOW] < state[HYST_JOINT_LOW_BEFORE]
                              ? state[HYST_JOINT_LOW]
                              : state[HYST_JOINT_LOW_BEFORE];
    const hyst_real high = state[HYST_JOINT_HIGH] > state[HYST_JOINT_HIGH_BEFORE]
                               ? state[HYST_JOINT_HIGH]
                               : state[HYST_JOINT_HIGH_BEFORE];
    const hyst_real side = scalar[HYST_SEARCH_SIDE];
    const hyst_real far = front_at(search, at, state, scalar[HYST_SEARCH_FAR]);
    if (!(side > ZERO || side < ZERO)) {
        if (!(state[HYST_JOINT_UPDATES] > ONE)) {
            scalar[HYST_SEARCH_HOME] = scalar[HYST_SEARCH_FAR] = u;
        } else {
            scalar[HYST_SEARCH_SIDE] = v > far ? ONE : v < far ? -ONE : ZERO;
        }
        return 0;
    }
    if ((v - far) * side > ZERO) {
        scalar[HYST_SEARCH_FAR] = u;
    } else if ((far - v) * side > HYST_REAL(0.125) * (high - low)) {
        const hyst_real home = front_at(search, at, state, scalar[HYST_SEARCH_HOME]);
        scalar[HYST_SEARCH_WAY] = (far - home) * side;
        scalar[HYST_SEARCH_HOME] = scalar[HYST_SEARCH_FAR];
        scalar[HYST_SEARCH_FAR] = u;
        scalar[HYST_SEARCH_SIDE] = -side;
        scalar[HYST_SEARCH_TURNS] += ONE;
        return 1;
    }
    return 0;
}

/* The covariance of a start from merged cells: independent gaps between radii. A radius then is the
 * share V_i / V_j of each later one and something independent of it, which is U D U' at once. */
static void believe(const hyst_search *search, const hyst_search_layout *at, hyst_real *rival,
                    hyst_real noise)
{
    const hyst_joint *joint = search->joint;
    const size_t n = joint->plays;
    const hyst_real *theta = rival + at->joint.theta;
    const hyst_real *r = theta + 1u + n;
    hyst_real *d = rival + at->joint.d;
    hyst_real *variance = rival + at->joint.scratch;
    hyst_real total = theta[0] > ZERO ? theta[0] : -theta[0];
    hyst_real sum = ZERO;
    for (size_t i = 0; i < n; ++i) {
        total += theta[1u + i] > ZERO ? theta[1u + i] : -theta[1u + i];
    }
    for (size_t i = 0; i <= n; ++i) {
        const hyst_real size = theta[i] > ZERO ? theta[i] : -theta[i];
        const hyst_real share = i > 0u ? HYST_REAL(0.01) : HYST_REAL(0.1);
        const hyst_real deviation = RIVAL_WEIGHT_SPREAD * (size + share * total);
        d[i] = deviation * deviation;
    }
    d[2u * n + 1u] = noise < joint->limit[2u * n + 1u] ? noise : joint->limit[2u * n + 1u];
    for (size_t i = 0; i < n; ++i) {
        const hyst_real least = HYST_REAL(0.05) * r[n - 1u] / (hyst_real)n;
        const hyst_real gap = r[i] - (i > 0u ? r[i - 1u] : ZERO);
        const hyst_real deviation = RIVAL_SPREAD * (gap > least ? gap : least);
        sum += deviation * deviation;
        variance[i] = sum;
    }
    for (size_t j = 0; j < n; ++j) {
        hyst_real *column = rival + at->joint.u + hyst_ud_length(1u + n + j);
        const hyst_real above = j + 1u < n ? variance[j + 1u] : variance[j];
        d[1u + n + j] = j + 1u < n ? variance[j] * ((above - variance[j]) / above) : above;
        for (size_t i = 0; i < j && variance[j] > ZERO; ++i) {
            column[1u + n + i] = variance[i] / variance[j];
        }
    }
}

/* Memory of a play of radius r between those of the cells next to it. */
static hyst_real cell_memory(const hyst_search *search, const hyst_search_layout *at,
                             const hyst_real *state, hyst_real r, hyst_real *gap)
{
    const hyst_real *radius = search->radius;
    const hyst_real *z = state + at->z;
    size_t k = 0;
    while (k + 2u < search->cells && radius[k + 1u] < r) {
        ++k;
    }
    if (k + 1u >= search->cells) {
        *gap = radius[0];
        return z[0];
    }
    *gap = radius[k + 1u] - radius[k];
    const hyst_real share = hyst_clamp(ZERO, ONE, (r - radius[k]) / *gap);
    return z[k] + share * (z[k + 1u] - z[k]);
}

static void remember(const hyst_search *search, const hyst_search_layout *at, hyst_real *state,
                     hyst_real u)
{
    const size_t n = search->joint->plays;
    const hyst_real *scalar = state + at->scalars;
    const hyst_real side = scalar[HYST_SEARCH_SIDE];
    const hyst_real home = front_at(search, at, state, scalar[HYST_SEARCH_HOME]);
    const hyst_real far = front_at(search, at, state, scalar[HYST_SEARCH_FAR]);
    hyst_real *rival = state + at->rival;
    for (size_t i = 0; i < n; ++i) {
        const hyst_real r = rival[at->joint.theta + 1u + n + i];
        const hyst_real inside = home + side * r;
        const hyst_real outside = far - side * r;
        const hyst_real z = (outside - inside) * side > ZERO ? outside : inside;
        const hyst_real off = rival[at->joint.z + i] - z;
        hyst_real gap = ZERO;
        (void)cell_memory(search, at, state, r, &gap);
        /* The last stroke took it from envelope to envelope, and no smaller one came between. */
        if (scalar[HYST_SEARCH_WAY] > HYST_REAL(2.0) * r && off <= gap && -off <= gap) {
            rival[at->joint.side + i] = side;
            rival[at->joint.home + i] = scalar[HYST_SEARCH_HOME];
            rival[at->joint.far + i] = scalar[HYST_SEARCH_FAR];
        }
    }
    rival[HYST_JOINT_STARTED] = ONE;
    rival[HYST_JOINT_INPUT] = u;
    hyst_joint_set_memory(search->joint, &at->joint, rival, u);
}

static void put_on_trial(const hyst_search *search, const hyst_search_layout *at, hyst_real *state,
                         hyst_real u)
{
    const hyst_joint *joint = search->joint;
    const size_t n = joint->plays;
    hyst_real *scalar = state + at->scalars;
    hyst_real *rival = state + at->rival;
    hyst_real *theta = rival + at->joint.theta;
    const hyst_real noise = scalar[HYST_SEARCH_NOISE] + HYST_REAL(8.0) * search->noise;
    hyst_real gap = ZERO;
    for (size_t j = 0; j < at->joint.m; ++j) {
        theta[j] = state[at->joint.theta + j];
    }
    theta[0] = state[at->weight];
    theta[1u + 2u * n] = state[at->weight + search->cells + 1u];
    for (size_t i = 0; i < n; ++i) {
        theta[1u + i] = state[at->point_weight + i];
        theta[1u + n + i] = state[at->point_radius + i];
    }
    hyst_joint_clamp(joint, theta);
    for (size_t i = 0; i < n; ++i) {
        rival[at->joint.z + i] = cell_memory(search, at, state, theta[1u + n + i], &gap);
    }
    hyst_joint_start(joint, rival, noise);
    believe(search, at, rival, noise);
    remember(search, at, state, u);
    scalar[HYST_SEARCH_GAIN] = ZERO;
    scalar[HYST_SEARCH_GAIN_SQUARED] = ZERO;
    scalar[HYST_SEARCH_RIVAL_SQUARE] = ZERO;
    scalar[HYST_SEARCH_RIVAL_PRODUCT] = ZERO;
    scalar[HYST_SEARCH_RIVAL_ERROR] = ZERO;
    scalar[HYST_SEARCH_TRIALS] += ONE;
    enter(scalar, ON_TRIAL);
}

/* The rival becomes the estimate; what was counted stays. */
static void replace(const hyst_search_layout *at, hyst_real *state)
{
    const hyst_real *rival = state + at->rival;
    for (size_t i = HYST_JOINT_ERROR; i <= HYST_JOINT_NOISE; ++i) {
        state[i] = rival[i];
    }
    for (size_t i = HYST_JOINT_THETA; i < at->joint.length; ++i) {
        state[i] = rival[i];
    }
    state[at->scalars + HYST_SEARCH_REPLACEMENTS] += ONE;
    state[at->scalars + HYST_SEARCH_ERROR] = rival[HYST_JOINT_ERROR];
    state[at->scalars + HYST_SEARCH_SEEN] = ZERO; /* errors so far were not its own */
}

static hyst_real square_over(hyst_real error, hyst_real noise)
{
    const hyst_real most = HYST_JOINT_OUTLIER;
    const hyst_real square = error * (error / noise);
    return square < most ? square : most;
}

/* Whether the rival's errors can be noise, or else are so much smaller that it does not matter. */
static int can_be_believed(const hyst_real *scalar)
{
    const hyst_real left = scalar[HYST_SEARCH_RIVAL_SQUARE];
    const hyst_real before = left + scalar[HYST_SEARCH_GAIN];
    return scalar[HYST_SEARCH_RIVAL_PRODUCT] < NO_NOISE * left || left < CLEAR_SHARE * before;
}

/* What the trial learns from one sample; noise is what the estimate takes for it. */
static void compare(const hyst_real *state, const hyst_real *rival, hyst_real *scalar)
{
    const hyst_real noise = state[HYST_JOINT_NOISE];
    const hyst_real error = rival[HYST_JOINT_ERROR];
    const hyst_real left = square_over(error, noise);
    const hyst_real gain = square_over(state[HYST_JOINT_ERROR], noise) - left;
    scalar[HYST_SEARCH_GAIN] += gain;
    scalar[HYST_SEARCH_GAIN_SQUARED] += gain * gain;
    scalar[HYST_SEARCH_RIVAL_SQUARE] += left;
    if (left < HYST_JOINT_OUTLIER) {
        scalar[HYST_SEARCH_RIVAL_PRODUCT] += error * (scalar[HYST_SEARCH_RIVAL_ERROR] / noise);
        scalar[HYST_SEARCH_RIVAL_ERROR] = error;
    }
}

static void judge(const hyst_search_layout *at, hyst_real *state)
{
    hyst_real *scalar = state + at->scalars;
    const hyst_real gain = scalar[HYST_SEARCH_GAIN];
    const hyst_real square = scalar[HYST_SEARCH_GAIN_SQUARED];
    if (gain > ZERO && gain * gain > BETTER * BETTER * square && can_be_believed(scalar)) {
        replace(at, state);
        enter(scalar, GATHERING);
    } else if ((gain < ZERO && gain * gain > WORSE * WORSE * square) ||
               scalar[HYST_SEARCH_TURNS] >= TURNS_OF_TRIAL) {
        enter(scalar, GATHERING);
    }
}

static void try_rival(const hyst_search *search, const hyst_search_layout *at, hyst_real *state,
                      hyst_real u, hyst_real y, int turned)
{
    hyst_real *scalar = state + at->scalars;
    hyst_real *rival = state + at->rival;
    if (hyst_joint_step(search->joint, rival, u, y) != HYST_JOINT_UPDATED) {
        enter(scalar, GATHERING);
        return;
    }
    /* Up to the first turn it finds its place. */
    if (scalar[HYST_SEARCH_TURNS] >= ONE) {
        compare(state, rival, scalar);
    }
    if (turned && scalar[HYST_SEARCH_TURNS] >= HYST_REAL(2.0)) {
        judge(at, state);
    }
}

static void watch_errors(const hyst_search *search, const hyst_search_layout *at, hyst_real *state)
{
    hyst_real *scalar = state + at->scalars;
    const hyst_real error = state[HYST_JOINT_ERROR];
    const hyst_real most = search->joint->noise_memory;
    if (error * (error / state[HYST_JOINT_VARIANCE]) < HYST_JOINT_OUTLIER) {
        scalar[HYST_SEARCH_SEEN] += scalar[HYST_SEARCH_SEEN] < most ? ONE : ZERO;
        const hyst_real share = ONE / scalar[HYST_SEARCH_SEEN];
        const hyst_real product = error * scalar[HYST_SEARCH_ERROR];
        scalar[HYST_SEARCH_SQUARE] += share * (error * error - scalar[HYST_SEARCH_SQUARE]);
        scalar[HYST_SEARCH_PRODUCT] += share * (product - scalar[HYST_SEARCH_PRODUCT]);
        scalar[HYST_SEARCH_ERROR] = error;
    }
}

hyst_joint_end hyst_search_step(const hyst_search *search, hyst_real *state, hyst_real u,
                                hyst_real y)
{
    const hyst_search_layout at = hyst_search_places(search);
    hyst_real *scalar = state + at.scalars;
    const hyst_real before = state[HYST_JOINT_INPUT];
    const hyst_joint_end end = hyst_joint_step(search->joint, state, u, y);
    if (end == HYST_JOINT_UPDATED) {
        watch_errors(search, &at, state);
    }
    if (search->cells == 0u || end == HYST_JOINT_WAS_SKIPPED) {
        return end;
    }
    const hyst_real v = front_at(search, &at, state, u);
    if (end == HYST_JOINT_WAS_REFUSED || !hyst_is_finite(v)) {
        enter(scalar, GATHERING);
        return end;
    }
    hyst_cells_follow(search, &at, state, v);
    const int turned = turns(search, &at, state, u, v);
    if ((u < before || u > before) && scalar[HYST_SEARCH_GROWTH] < MOST_GROWTH) {
        scalar[HYST_SEARCH_GROWTH] *= ONE + HYST_REAL(0.5) * search->joint->forgetting;
    }
    if (scalar[HYST_SEARCH_STAGE] >= ON_TRIAL) {
        try_rival(search, &at, state, u, y, turned);
    } else if (scalar[HYST_SEARCH_STAGE] >= MERGING) {
        if (scalar[HYST_SEARCH_COUNT] > (hyst_real)search->joint->plays) {
            hyst_cells_merge(&at, state);
        } else {
            put_on_trial(search, &at, state, u);
        }
    } else if (!turned) {
        hyst_cells_measure(search, &at, state, v, y);
    } else {
        hyst_cells_forget(search, &at, state);
        if (scalar[HYST_SEARCH_TURNS] >= TURNS_TO_GATHER) {
            hyst_cells_begin_merging(search, &at, state);
            enter(scalar, MERGING);
        }
    }
    return end;
}

void hyst_search_follow(const hyst_search *search, hyst_real *state, hyst_real u)
{
    const hyst_search_layout at = hyst_search_places(search);
    hyst_joint_follow(search->joint, &at.joint, state, u);
    hyst_joint_set_memory(search->joint, &at.joint, state, u);
    state[HYST_JOINT_INPUT] = u;
    if (search->cells > 0u) {
        hyst_cells_follow(search, &at, state, front_at(search, &at, state, u));
        if (state[at.scalars + HYST_SEARCH_STAGE] >= ON_TRIAL) {
            enter(state + at.scalars, GATHERING);
        }
    }
}

hyst_real hyst_search_correlation(const hyst_search *search, const hyst_real *state)
{
    const hyst_real *scalar = state + hyst_search_places(search).scalars;
    const hyst_real square = scalar[HYST_SEARCH_SQUARE];
    return square > ZERO ? hyst_clamp(-ONE, ONE, scalar[HYST_SEARCH_PRODUCT] / square) : ZERO;
}
