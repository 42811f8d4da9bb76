/* Radii of plays from the measured slope and one linear regression: one sample. */
#include "hyst/radius_estimator.h"

#include "hyst/finite.h"
#include "hyst/isotonic.h"
#include "hyst/ud_factor.h"

#define ZERO HYST_REAL(0.0)
#define ONE HYST_REAL(1.0)
/* As many of the last errors are averaged. */
#define ERRORS HYST_REAL(150.0)

hyst_radius_layout hyst_radius_places(const hyst_radius *radius)
{
    hyst_radius_layout at;
    const size_t n = radius->plays;
    at.r = HYST_RADIUS_R;
    at.free = at.r + n;
    at.home = at.free + n;
    at.side = at.home + n;
    at.age = at.side + n;
    at.d = at.age + n;
    at.u = at.d + n;
    at.scratch = at.u + (n > 0u ? hyst_ud_length(n) : 0u);
    at.length = at.scratch + 6u * n;
    return at;
}

void hyst_radius_start(const hyst_radius *radius, hyst_real *state, const hyst_real *z0)
{
    const hyst_radius_layout at = hyst_radius_places(radius);
    for (size_t i = 0; i < HYST_RADIUS_R; ++i) {
        state[i] = ZERO;
    }
    for (size_t i = at.home; i < at.length; ++i) {
        state[i] = ZERO;
    }
    for (size_t i = 0; i < radius->plays; ++i) {
        state[at.free + i] = state[at.r + i];
        state[at.home + i] = z0[i];
        state[at.d + i] = radius->limit[i];
    }
    state[HYST_RADIUS_REGIME] = -ONE;
}

/* Every play that was on its envelope leaves it where the input turned. */
static void turn(const hyst_radius *radius, const hyst_radius_layout *at, hyst_real *state,
                 hyst_real direction)
{
    for (size_t i = 0; i < radius->plays; ++i) {
        if ((hyst_real)i < state[HYST_RADIUS_MOST]) {
            if (state[at->side + i] * direction < ZERO) {
                state[at->age + i] = ZERO;
            }
            state[at->home + i] = state[HYST_RADIUS_EXTREME];
            state[at->side + i] = direction;
        }
    }
    state[HYST_RADIUS_DIRECTION] = direction;
    state[HYST_RADIUS_MEAN_U] = state[HYST_RADIUS_EXTREME];
    state[HYST_RADIUS_MEAN_Y] = state[HYST_RADIUS_OUTPUT];
    state[HYST_RADIUS_UU] = ZERO;
    state[HYST_RADIUS_UY] = ZERO;
    state[HYST_RADIUS_SINCE] = ZERO;
    state[HYST_RADIUS_MOST] = ZERO;
    state[HYST_RADIUS_REGIME] = -ONE;
}

static void follow_input(const hyst_radius *radius, const hyst_radius_layout *at,
                         hyst_real *state, hyst_real u, hyst_real y)
{
    const hyst_real s = state[HYST_RADIUS_DIRECTION];
    const hyst_real away = u - state[HYST_RADIUS_EXTREME];
    const hyst_real back = s < ZERO ? away : -away;
    if (!(s > ZERO || s < ZERO)) {
        if (away > radius->dead_band || -away > radius->dead_band) {
            turn(radius, at, state, away > ZERO ? ONE : -ONE);
        }
    } else if (back > radius->dead_band) {
        turn(radius, at, state, -s);
    }
    if ((u - state[HYST_RADIUS_EXTREME]) * state[HYST_RADIUS_DIRECTION] > ZERO) {
        state[HYST_RADIUS_EXTREME] = u;
        state[HYST_RADIUS_OUTPUT] = y;
    }
    for (size_t i = 0; i < radius->plays; ++i) {
        state[at->age + i] += ONE;
    }
}

/* The regression of y on u since the last reversal; 1 if it gives a slope. */
static int filter_slope(const hyst_radius *radius, hyst_real *state, hyst_real u, hyst_real y)
{
    const hyst_real du = u - state[HYST_RADIUS_MEAN_U];
    const hyst_real dy = y - state[HYST_RADIUS_MEAN_Y];
    const hyst_real share = ONE - radius->memory;
    state[HYST_RADIUS_UU] = radius->memory * state[HYST_RADIUS_UU] + du * du;
    state[HYST_RADIUS_UY] = radius->memory * state[HYST_RADIUS_UY] + du * dy;
    state[HYST_RADIUS_MEAN_U] += share * du;
    state[HYST_RADIUS_MEAN_Y] += share * dy;
    state[HYST_RADIUS_SINCE] += ONE;
    if (radius->plays == 0u || !(state[HYST_RADIUS_UU] > ZERO) ||
        state[HYST_RADIUS_SINCE] <= radius->dead_time) {
        return 0;
    }
    state[HYST_RADIUS_SLOPE] = state[HYST_RADIUS_UY] / state[HYST_RADIUS_UU];
    return 1;
}

/* The regime of the slope of the model that is nearest to the slope, or -1. */
static hyst_real regime_of_slope(const hyst_radius *radius, hyst_real slope)
{
    hyst_real sum = radius->p0;
    size_t regime = 0;
    size_t i = 0;
    /* Up to the middle between two slopes it is the lower one. */
    for (; i < radius->plays && slope > sum + HYST_REAL(0.5) * radius->p[i]; ++i) {
        sum += radius->p[i];
        regime = i + 1u;
    }
    const hyst_real off = slope - sum;
    const hyst_real gap = off > ZERO ? (i < radius->plays ? radius->p[i] : radius->p[i - 1u])
                                     : (regime > 0u ? radius->p[regime - 1u] : radius->p[0]);
    const hyst_real most = HYST_REAL(0.5) * radius->tolerance * gap;
    return off <= most && -off <= most ? (hyst_real)regime : -ONE;
}

static void enter_regime(hyst_real *state, hyst_real regime)
{
    state[HYST_RADIUS_REGIME] = regime;
    if (regime > state[HYST_RADIUS_MOST]) {
        state[HYST_RADIUS_MOST] = regime;
    }
}

/* A regime from outside is the truth at once, also at rest and before there is a slope; but before
 * the first reversal that counts nobody knows which envelope is meant. */
static void take_regime(const hyst_radius *radius, hyst_real *state, hyst_real regime)
{
    const int goes = state[HYST_RADIUS_DIRECTION] > ZERO || state[HYST_RADIUS_DIRECTION] < ZERO;
    enter_regime(state, goes ? regime : -ONE);
    if (state[HYST_RADIUS_SINCE] <= radius->dead_time) {
        state[HYST_RADIUS_REGIME] = -ONE;
    }
}

/* Fills phi and returns the prediction error. */
static hyst_real regress(const hyst_radius *radius, const hyst_radius_layout *at,
                         const hyst_real *state, hyst_real u, hyst_real y, hyst_real *phi)
{
    hyst_real error = y - radius->p0 * u;
    for (size_t i = 0; i < radius->plays; ++i) {
        const int outside = (hyst_real)i < state[HYST_RADIUS_REGIME];
        const hyst_real from = outside ? u : state[at->home + i];
        const hyst_real by_r = outside ? -state[HYST_RADIUS_DIRECTION] : state[at->side + i];
        phi[i] = radius->p[i] * by_r;
        error -= radius->p[i] * from + phi[i] * state[at->free + i];
    }
    return error;
}

static void descend(const hyst_radius *radius, const hyst_radius_layout *at,
                    const hyst_real *state, const hyst_real *phi, hyst_real error, hyst_real *r)
{
    for (size_t i = 0; i < radius->plays; ++i) {
        r[i] = state[at->free + i] + radius->gain[i] * phi[i] * error;
    }
}

static void least_squares(const hyst_radius *radius, const hyst_radius_layout *at,
                          hyst_real *state, const hyst_real *phi, hyst_real error, hyst_real *r)
{
    const size_t n = radius->plays;
    hyst_real *gain = r + n;
    hyst_real *scale = gain + n;
    hyst_real *variance = scale + n;
    hyst_ud_variances(n, state + at->u, state + at->d, variance);
    for (size_t i = 0; i < n; ++i) {
        const int room = variance[i] * radius->growth * radius->growth <= radius->limit[i];
        scale[i] = room ? radius->growth : ONE;
    }
    hyst_ud_scale(n, state + at->u, state + at->d, scale);
    const hyst_real a = hyst_ud_update(n, state + at->u, state + at->d, phi, ONE, gain, scale);
    for (size_t i = 0; i < n; ++i) {
        r[i] = state[at->free + i] + gain[i] * (error / a);
    }
}

/* The first input: plays that it is farther from than their radii go with it (S2 eq. 1). */
static void begin_input(const hyst_radius *radius, const hyst_radius_layout *at, hyst_real *state,
                        hyst_real u)
{
    state[HYST_RADIUS_INPUT] = state[HYST_RADIUS_EXTREME] = u;
    for (size_t i = 0; i < radius->plays; ++i) {
        const hyst_real way = u - state[at->home + i];
        if (way > state[at->r + i] || -way > state[at->r + i]) {
            state[at->home + i] = u;
            state[at->side + i] = way > ZERO ? -ONE : ONE;
        }
    }
}

/* Outputs before this one were not measured, so the slope begins here; it can do so for good once the
 * output at the farthest input is known. */
static void begin_slope(hyst_real *state, hyst_real u, hyst_real y)
{
    state[HYST_RADIUS_MEAN_U] = u;
    state[HYST_RADIUS_MEAN_Y] = y;
    state[HYST_RADIUS_UU] = state[HYST_RADIUS_UY] = ZERO;
    state[HYST_RADIUS_REGIME] = -ONE;
    if (!(u < state[HYST_RADIUS_EXTREME] || u > state[HYST_RADIUS_EXTREME])) {
        state[HYST_RADIUS_OUTPUT] = y;
        state[HYST_RADIUS_STARTED] = ONE;
    }
}

/* Follows the input; 1 if it moved, 0 if not, -1 if the sample teaches nothing. */
static int advance(const hyst_radius *radius, const hyst_radius_layout *at, hyst_real *state,
                   hyst_real u, hyst_real y)
{
    /* Squares of what is taken in are summed over many samples, so absurd sizes are refused here. */
    if (!hyst_is_finite(HYST_REAL(1e10) * (u * u + y * y))) {
        state[HYST_RADIUS_SKIPPED] += ONE;
        return -1;
    }
    if (!(state[HYST_RADIUS_STARTED] > ZERO)) {
        state[HYST_RADIUS_STARTED] = ONE;
        begin_input(radius, at, state, u);
        state[HYST_RADIUS_OUTPUT] = y;
        return -1;
    }
    const int moves = u < state[HYST_RADIUS_INPUT] || u > state[HYST_RADIUS_INPUT];
    if (moves) {
        follow_input(radius, at, state, u, y);
    }
    state[HYST_RADIUS_INPUT] = u;
    if (state[HYST_RADIUS_STARTED] > ONE) {
        begin_slope(state, u, y);
        return -1;
    }
    return moves;
}

static int learn(const hyst_radius *radius, const hyst_radius_layout *at, hyst_real *state,
                 hyst_real u, hyst_real y)
{
    const size_t n = radius->plays;
    hyst_real *phi = state + at->scratch;
    hyst_real *r = phi + n;
    /* Within the dead band behind the farthest input nobody knows yet whether plays have left their
     * envelopes. */
    const hyst_real ahead = (u - state[HYST_RADIUS_EXTREME]) * state[HYST_RADIUS_DIRECTION];
    if (n == 0u || state[HYST_RADIUS_REGIME] < ZERO || ahead < ZERO) {
        return 0;
    }
    const hyst_real error = regress(radius, at, state, u, y, phi);
    if (radius->least_squares) {
        least_squares(radius, at, state, phi, error, r);
    } else {
        descend(radius, at, state, phi, error, r);
    }
    hyst_real sum = error * error;
    for (size_t i = 0; i < n; ++i) {
        sum += r[i];
    }
    if (!hyst_is_finite(sum)) {
        state[HYST_RADIUS_SKIPPED] += ONE;
        return 0;
    }
    /* Least squares goes on from where it was: its estimate of each radius takes the others' into
     * account, which a projection of some of them would undo. The gradient is projected itself. */
    for (size_t i = 0; i < n; ++i) {
        state[at->free + i] = state[at->r + i] = r[i];
    }
    hyst_isotonic_weighted(n, state + at->r, radius->least_squares ? NULL : radius->gain, ZERO,
                           radius->most_radius);
    for (size_t i = 0; i < n && !radius->least_squares; ++i) {
        state[at->free + i] = state[at->r + i];
    }
    state[HYST_RADIUS_UPDATES] += ONE;
    const hyst_real share = state[HYST_RADIUS_UPDATES] < ERRORS ? ONE / state[HYST_RADIUS_UPDATES]
                                                                : ONE / ERRORS;
    state[HYST_RADIUS_SQUARES] += share * (error * error - state[HYST_RADIUS_SQUARES]);
    state[HYST_RADIUS_PRODUCTS] +=
        share * (error * state[HYST_RADIUS_ERROR] - state[HYST_RADIUS_PRODUCTS]);
    state[HYST_RADIUS_ERROR] = error;
    return 1;
}

int hyst_radius_step(const hyst_radius *radius, hyst_real *state, hyst_real u, hyst_real y)
{
    const hyst_radius_layout at = hyst_radius_places(radius);
    const int moves = advance(radius, &at, state, u, y);
    if (moves < 0) {
        return 0;
    }
    /* While the input rests the regime is what it was. */
    if (moves) {
        const int has_slope = filter_slope(radius, state, u, y);
        enter_regime(state, has_slope ? regime_of_slope(radius, state[HYST_RADIUS_SLOPE]) : -ONE);
    }
    return learn(radius, &at, state, u, y);
}

int hyst_radius_step_told(const hyst_radius *radius, hyst_real *state, hyst_real u, hyst_real y,
                          int is_slope, hyst_real told)
{
    const hyst_radius_layout at = hyst_radius_places(radius);
    const int moves = advance(radius, &at, state, u, y);
    if (moves < 0) {
        return 0;
    }
    if (moves) {
        (void)filter_slope(radius, state, u, y);
    }
    if (hyst_is_finite(told)) {
        if (is_slope) {
            state[HYST_RADIUS_SLOPE] = told;
            told = radius->plays > 0u ? regime_of_slope(radius, told) : -ONE;
        } else {
            told = told >= ZERO && told <= (hyst_real)radius->plays ? told : -ONE;
        }
        take_regime(radius, state, told);
    } else if (moves) {
        state[HYST_RADIUS_REGIME] = -ONE;
    }
    const int used = learn(radius, &at, state, u, y);
    state[HYST_RADIUS_TOLD] += used ? ONE : ZERO;
    return used;
}

void hyst_radius_follow(const hyst_radius *radius, hyst_real *state, hyst_real u)
{
    const hyst_radius_layout at = hyst_radius_places(radius);
    if (!hyst_is_finite(HYST_REAL(1e10) * (u * u))) {
        state[HYST_RADIUS_SKIPPED] += ONE;
        return;
    }
    if (!(state[HYST_RADIUS_STARTED] > ZERO)) {
        begin_input(radius, &at, state, u);
    }
    state[HYST_RADIUS_STARTED] = HYST_REAL(2.0);
    state[HYST_RADIUS_REGIME] = -ONE;
    if (!(u < state[HYST_RADIUS_INPUT] || u > state[HYST_RADIUS_INPUT])) {
        return;
    }
    follow_input(radius, &at, state, u, ZERO);
    state[HYST_RADIUS_INPUT] = u;
    const hyst_real s = state[HYST_RADIUS_DIRECTION];
    for (size_t i = 0; i < radius->plays; ++i) {
        const hyst_real r = state[at.r + i];
        const hyst_real way = s * (u - state[at.home + i]) - s * state[at.side + i] * r;
        if (way < r || !(s > ZERO || s < ZERO)) {
            break;
        }
        if ((hyst_real)(i + 1u) > state[HYST_RADIUS_MOST]) {
            state[HYST_RADIUS_MOST] = (hyst_real)(i + 1u);
        }
    }
}
