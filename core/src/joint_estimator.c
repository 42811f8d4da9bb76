/* Joint estimation of radii, weights, offset and maps: one sample. */
#include "hyst/joint_estimator.h"

#include "hyst/guard.h"
#include "hyst/isotonic.h"
#include "hyst/play.h"
#include "hyst/power.h"
#include "hyst/ud_factor.h"

#define ZERO HYST_REAL(0.0)
#define ONE HYST_REAL(1.0)

size_t hyst_joint_parameters(const hyst_joint *joint)
{
    return 2 + 2 * joint->plays + joint->front.count + joint->back.count;
}

hyst_joint_layout hyst_joint_places(const hyst_joint *joint)
{
    hyst_joint_layout at;
    const size_t n = joint->plays;
    at.m = hyst_joint_parameters(joint);
    at.theta = HYST_JOINT_THETA;
    at.d = at.theta + at.m;
    at.u = at.d + at.m;
    at.z = at.u + hyst_ud_length(at.m);
    at.side = at.z + n;
    at.age = at.side + n;
    at.home = at.age + n;
    at.far = at.home + n;
    at.psi = at.far + n;
    at.scratch = at.psi + at.m;
    at.length = at.scratch + 4 * at.m + hyst_ud_length(at.m);
    return at;
}

void hyst_joint_start(const hyst_joint *joint, hyst_real *state, hyst_real noise,
                      hyst_real extra_forgetting)
{
    const hyst_joint_layout at = hyst_joint_places(joint);
    for (size_t i = 0; i < HYST_JOINT_THETA; ++i) {
        state[i] = ZERO;
    }
    for (size_t i = at.d; i < at.z; ++i) {
        state[i] = ZERO;
    }
    for (size_t i = at.side; i < at.length; ++i) {
        state[i] = ZERO;
    }
    for (size_t j = 0; j < at.m; ++j) {
        state[at.d + j] = joint->limit[j];
    }
    for (size_t i = 0; i < joint->plays; ++i) {
        state[at.age + i] = joint->patience;
    }
    state[HYST_JOINT_NOISE] = noise;
    state[HYST_JOINT_FADING] = extra_forgetting;
}

/* S(x, rho) of dead_zone.h. */
static hyst_real dead_zone(hyst_real x, hyst_real rho)
{
    if (rho > ZERO) {
        return x > rho ? x - rho : ZERO;
    }
    if (rho < ZERO) {
        return x < rho ? x - rho : ZERO;
    }
    return x;
}

static hyst_real mapped(const hyst_joint_map *map, const hyst_real *weight, hyst_real x)
{
    hyst_real y = map->count == 0 ? x : ZERO;
    for (size_t j = 0; j < map->count; ++j) {
        y += weight[j] * dead_zone(x, map->threshold[j]);
    }
    return y;
}

static hyst_real slope_of_map(const hyst_joint_map *map, const hyst_real *weight, hyst_real x)
{
    hyst_real slope = map->count == 0 ? ONE : ZERO;
    for (size_t j = 0; j < map->count; ++j) {
        const hyst_real rho = map->threshold[j];
        const int acts = rho > ZERO ? x > rho : rho < ZERO ? x < rho : 1;
        slope += acts ? weight[j] : ZERO;
    }
    return slope;
}

/* What the present estimate says of a play: z and its derivatives by r and by both ends of its way. */
typedef struct {
    hyst_real z, by_r, by_home, by_far, doubt;
} regime;

/* The play has gone from its home envelope, left at home, as far as far:
 *   z = home + side (r + h(x)),  x = |far - home| - 2 r,  h(x) = max(x, 0).
 * The radius is known to +- a standard error, so h is its mean, its slope the regression of h on r,
 * and what that leaves unexplained adds to the noise; all for a uniform x of half width w. */
static regime regime_of(hyst_real home, hyst_real far, hyst_real side, hyst_real r, hyst_real w)
{
    const hyst_real way = (far - home) * side;
    const hyst_real x = way - HYST_REAL(2.0) * r;
    regime is = {home + side * r, side, ONE, ZERO, ZERO};
    if (x >= w) {
        is.z = far - side * r;
        is.by_r = -side;
        is.by_home = ZERO;
        is.by_far = ONE;
    } else if (x > -w) {
        const hyst_real q = (x + w) / (HYST_REAL(2.0) * w);
        const hyst_real slope = q * q * (HYST_REAL(3.0) - HYST_REAL(2.0) * q);
        const hyst_real spread = q * q * q * (HYST_REAL(4.0) - HYST_REAL(3.0) * q) - slope * slope;
        is.z += side * w * q * q;
        is.by_r = side * (ONE - HYST_REAL(2.0) * slope);
        is.by_home = ONE - slope;
        is.by_far = slope;
        is.doubt = w * w * spread / HYST_REAL(3.0);
    }
    return is;
}

static hyst_real front_at(const hyst_joint *joint, const hyst_real *theta, hyst_real u)
{
    return mapped(&joint->front, theta + 2 + 2 * joint->plays, u);
}

/* Follows the way of play i: home and far end, as inputs u. */
static void move_play(const hyst_joint *joint, const hyst_joint_layout *at, hyst_real *state,
                      size_t i, hyst_real u, hyst_real v)
{
    const hyst_real *theta = state + at->theta;
    const hyst_real r = theta[1 + joint->plays + i];
    hyst_real *home = &state[at->home + i];
    hyst_real *far = &state[at->far + i];
    hyst_real *side = &state[at->side + i];
    hyst_real *age = &state[at->age + i];
    *age += *age < joint->patience ? ONE : ZERO;
    if (!(*side > ZERO || *side < ZERO)) { /* nothing but the memory it started with is known */
        const hyst_real z = state[at->z + i];
        *side = v - r > z ? -ONE : v + r < z ? ONE : ZERO;
        *home = *far = u;
        return;
    }
    if ((*far - u) * *side > ZERO) { /* it turns */
        const hyst_real way =
            (front_at(joint, theta, *far) - front_at(joint, theta, *home)) * *side;
        if (way > HYST_REAL(2.0) * r) {
            *home = *far;
            *far = u;
            *side = -*side;
            *age = ZERO;
        }
    }
    if ((*home - u) * *side > ZERO) {
        *home = *far = u;
    } else if ((u - *far) * *side > ZERO) {
        *far = u;
    }
}

/* Gradient of w, before the back map; returns w and adds to *doubt what the linear model leaves. */
static hyst_real predict_plays(const hyst_joint *joint, const hyst_joint_layout *at,
                               hyst_real *state, hyst_real u, hyst_real v,
                               const hyst_real *variance, hyst_real *doubt)
{
    const size_t n = joint->plays;
    const hyst_real *theta = state + at->theta;
    hyst_real *psi = state + at->psi;
    hyst_real *by_front = psi + 2 + 2 * n;
    hyst_real w = theta[0] * v;
    psi[0] = v;
    for (size_t j = 0; j < joint->front.count; ++j) {
        by_front[j] = theta[0] * dead_zone(u, joint->front.threshold[j]);
    }
    for (size_t i = 0; i < n; ++i) {
        const hyst_real p = theta[1 + i];
        const hyst_real r = theta[1 + n + i];
        const hyst_real of_r = variance[1 + n + i];
        const hyst_real side = state[at->side + i];
        const hyst_real home = state[at->home + i];
        const hyst_real far = state[at->far + i];
        regime is = {state[at->z + i], ZERO, ZERO, ZERO, ZERO};
        if (side > ZERO || side < ZERO) {
            const hyst_real width = hyst_power(HYST_REAL(12.0) * of_r, HYST_REAL(0.5));
            is = regime_of(front_at(joint, theta, home), front_at(joint, theta, far), side, r,
                           width);
        }
        psi[1 + i] = is.z;
        psi[1 + n + i] = p * is.by_r;
        w += p * is.z;
        *doubt += p * p * is.doubt + variance[1 + i] * of_r;
        for (size_t j = 0; j < joint->front.count; ++j) {
            const hyst_real rho = joint->front.threshold[j];
            by_front[j] += p * (is.by_home * dead_zone(home, rho) + is.by_far * dead_zone(far, rho));
        }
    }
    return w;
}

/* Fills the gradient and returns the predicted output. */
static hyst_real predict(const hyst_joint *joint, const hyst_joint_layout *at, hyst_real *state,
                         hyst_real u, hyst_real v, const hyst_real *variance, hyst_real *doubt)
{
    const size_t n = joint->plays;
    const size_t before_back = 2 + 2 * n + joint->front.count;
    const hyst_real *back = state + at->theta + before_back;
    hyst_real *psi = state + at->psi;
    const hyst_real w = predict_plays(joint, at, state, u, v, variance, doubt);
    const hyst_real slope = slope_of_map(&joint->back, back, w);
    for (size_t j = 0; j < before_back; ++j) {
        psi[j] *= slope;
    }
    *doubt *= slope * slope;
    psi[1 + 2 * n] = ONE;
    for (size_t j = 0; j < joint->back.count; ++j) {
        psi[before_back + j] = dead_zone(w, joint->back.threshold[j]);
    }
    return mapped(&joint->back, back, w) + state[at->theta + 1 + 2 * n];
}

/* Whether play i has been on both envelopes lately. */
static int is_excited(const hyst_joint *joint, const hyst_joint_layout *at, const hyst_real *state,
                      size_t i)
{
    return state[at->age + i] < joint->patience;
}

/* Lets the variances of what is excited grow, up to their limits. scale: scratch. */
static void forget(const hyst_joint *joint, const hyst_joint_layout *at, hyst_real *state,
                   hyst_real *scale, const hyst_real *variance)
{
    const size_t n = joint->plays;
    const hyst_real forgotten = joint->forgetting + state[HYST_JOINT_FADING];
    if (!(forgotten > ZERO)) {
        return;
    }
    /* 1 / sqrt(1 - x) to third order. */
    const hyst_real growth =
        ONE + forgotten * (HYST_REAL(0.5) + HYST_REAL(0.375) * forgotten);
    for (size_t j = 0; j < at->m; ++j) {
        const int of_a_play = j >= 1 && j <= 2 * n;
        const int moves = !of_a_play || is_excited(joint, at, state, (j - 1) % n);
        scale[j] = moves && variance[j] * growth * growth <= joint->limit[j] ? growth : ONE;
    }
    hyst_ud_scale(at->m, state + at->u, state + at->d, scale);
    state[HYST_JOINT_FADING] *= joint->fading;
}

/* Clamps the partial sums first + weight_1 + .. + weight_j to their bounds. */
static void keep_rising(size_t count, hyst_real first, hyst_real *weight, hyst_real least,
                        hyst_real most)
{
    hyst_real before = first;
    for (size_t j = 0; j < count; ++j) {
        const hyst_real sum = hyst_clamp(least, most, before + weight[j]);
        /* An untouched weight keeps its bits. */
        if (sum < before + weight[j] || sum > before + weight[j]) {
            weight[j] = sum - before;
        }
        before = sum;
    }
}

static void keep_map_rising(const hyst_joint_map *map, hyst_real *weight)
{
    if (map->count == 0) {
        return;
    }
    const size_t negative = map->count - 1 - map->positive;
    keep_rising(1, ZERO, weight, map->least_slope, map->most_slope);
    keep_rising(map->positive, weight[0], weight + 1, map->least_slope, map->most_slope);
    keep_rising(negative, weight[0], weight + 1 + map->positive, map->least_slope,
                map->most_slope);
}

/* What the inequalities of a model that can be inverted are: sums of theta over a range, each within
 * bounds, or the steps between radii. */
typedef struct {
    size_t first, last; /* +1 from first to last */
    size_t minus;       /* -1 here, where it is not `first` */
    hyst_real least, most;
} inequality;

static inequality inequality_of(const hyst_joint *joint, size_t k)
{
    const size_t n = joint->plays;
    if (k <= n) {
        const inequality slope = {0, k, 0, joint->least_slope, joint->most_slope};
        return slope;
    }
    const inequality order = {k, k, k == n + 1 ? k : k - 1, ZERO, joint->most_radius};
    return order;
}

/* Takes the estimate to the nearest point, in the metric of its own covariance, that satisfies
 * an inequality. Changing one parameter alone would undo what the others have been fitted to. */
static int satisfy(const hyst_joint_layout *at, inequality must, hyst_real *theta,
                   hyst_real *a, hyst_real *product)
{
    const hyst_real *d = theta + at->m;
    hyst_real value = must.minus == must.first ? ZERO : -theta[must.minus];
    for (size_t j = must.first; j <= must.last; ++j) {
        value += theta[j];
    }
    const hyst_real excess = value - hyst_clamp(must.least, must.most, value);
    if (!(excess < ZERO || excess > ZERO)) {
        return 0;
    }
    for (size_t j = 0; j < at->m; ++j) {
        a[j] = j >= must.first && j <= must.last ? ONE : ZERO;
    }
    if (must.minus != must.first) {
        a[must.minus] = -ONE;
    }
    const hyst_real variance = hyst_ud_times(at->m, d + at->m, d, a, product);
    const hyst_real share = excess / variance;
    if (variance > ZERO && hyst_is_finite(share)) {
        for (size_t j = 0; j < at->m; ++j) {
            theta[j] -= share * product[j];
        }
    }
    return 1;
}

static void project_in_metric(const hyst_joint *joint, const hyst_joint_layout *at,
                              hyst_real *theta, hyst_real *a, hyst_real *product)
{
    const size_t count = 2 * joint->plays + 1;
    size_t left = HYST_JOINT_PROJECTIONS;
    for (size_t k = 0; k < count && left > 0; ++k) {
        left -= (size_t)satisfy(at, inequality_of(joint, k), theta, a, product);
    }
}

static void project(const hyst_joint *joint, hyst_real *theta)
{
    const size_t n = joint->plays;
    hyst_real *front = theta + 2 + 2 * n;
    keep_rising(n + 1, ZERO, theta, joint->least_slope, joint->most_slope);
    hyst_isotonic(n, theta + 1 + n, ZERO, joint->most_radius);
    keep_map_rising(&joint->front, front);
    keep_map_rising(&joint->back, front + joint->front.count);
}

/* The memory that goes with the new parameters, one that an input could have left. */
static void set_memory(const hyst_joint *joint, const hyst_joint_layout *at, hyst_real *state,
                       hyst_real u)
{
    const size_t n = joint->plays;
    const hyst_real *theta = state + at->theta;
    hyst_real *z = state + at->z;
    hyst_real from = front_at(joint, theta, u);
    hyst_real within = ZERO;
    for (size_t i = 0; i < n; ++i) {
        const hyst_real r = theta[1 + n + i];
        const hyst_real side = state[at->side + i];
        if (side > ZERO || side < ZERO) {
            z[i] = regime_of(front_at(joint, theta, state[at->home + i]),
                             front_at(joint, theta, state[at->far + i]), side, r, ZERO)
                       .z;
        }
        z[i] = hyst_play(from, r - within, z[i]);
        from = z[i];
        within = r;
    }
}

static int all_finite(const hyst_real *value, size_t count)
{
    hyst_real sum = ZERO;
    for (size_t i = 0; i < count; ++i) {
        sum += value[i] - value[i]; /* 0, or NaN for good */
    }
    return hyst_is_finite(sum);
}

static void copy(hyst_real *to, const hyst_real *from, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        to[i] = from[i];
    }
}

/* The noise follows the errors, each counting for at most HYST_JOINT_OUTLIER times what is usual. */
static hyst_real noise_after(const hyst_joint *joint, const hyst_real *state, hyst_real surprise)
{
    const hyst_real noise = state[HYST_JOINT_NOISE];
    const hyst_real memory = state[HYST_JOINT_UPDATES] + HYST_REAL(20.0);
    const hyst_real change = hyst_clamp(-ONE, HYST_JOINT_OUTLIER - ONE, surprise - ONE);
    const hyst_real updated =
        noise + change * noise / (memory < joint->noise_memory ? memory : joint->noise_memory);
    return updated > joint->least_noise ? updated : joint->least_noise;
}

/* The measurement, on copies that replace the state only if all of them are finite. */
static int measure(const hyst_joint *joint, const hyst_joint_layout *at, hyst_real *state,
                   hyst_real error, hyst_real doubt)
{
    const size_t m = at->m;
    const size_t count = 2 * m + hyst_ud_length(m);
    hyst_real *theta = state + at->scratch;
    hyst_real *d = theta + m; /* and the packed U after it, as in the state */
    hyst_real *gain = d + m + hyst_ud_length(m);
    hyst_real *f = gain + m;
    copy(theta, state + at->theta, count);
    const hyst_real a = hyst_ud_update(m, d + m, d, state + at->psi,
                                       state[HYST_JOINT_NOISE] + doubt, gain, f);
    const hyst_real surprise = error * (error / a);
    const hyst_real most = HYST_JOINT_OUTLIER;
    const hyst_real step = error / a * (surprise > most ? most / surprise : ONE);
    for (size_t j = 0; j < m; ++j) {
        const hyst_real least = joint->least_share * joint->limit[j];
        theta[j] += step * gain[j];
        d[j] = d[j] > least ? d[j] : least;
    }
    if (!hyst_is_finite(a) || !hyst_is_finite(surprise) || !all_finite(theta, count)) {
        return 0;
    }
    project_in_metric(joint, at, theta, gain, f);
    if (!all_finite(theta, m)) {
        return 0;
    }
    project(joint, theta);
    copy(state + at->theta, theta, count);
    state[HYST_JOINT_NOISE] = noise_after(joint, state, surprise);
    state[HYST_JOINT_VARIANCE] = a;
    state[HYST_JOINT_UPDATES] += ONE;
    return 1;
}

static void watch_range(const hyst_joint *joint, hyst_real *state, hyst_real v, int started)
{
    const hyst_real low = state[HYST_JOINT_LOW];
    const hyst_real high = state[HYST_JOINT_HIGH];
    const hyst_real leak = started ? (high - low) / joint->patience : ZERO;
    state[HYST_JOINT_LOW] = !started || v < low + leak ? v : low + leak;
    state[HYST_JOINT_HIGH] = !started || v > high - leak ? v : high - leak;
}

hyst_joint_end hyst_joint_step(const hyst_joint *joint, hyst_real *state, hyst_real u, hyst_real y)
{
    const hyst_joint_layout at = hyst_joint_places(joint);
    const hyst_real *front = state + at.theta + 2 + 2 * joint->plays;
    const hyst_real v = hyst_is_finite(u) ? mapped(&joint->front, front, u) : u;
    if (!hyst_is_finite(v) || !hyst_is_finite(y)) {
        state[HYST_JOINT_SKIPPED] += ONE;
        return HYST_JOINT_WAS_SKIPPED;
    }
    const int started = state[HYST_JOINT_STARTED] > ZERO;
    const int moves = started && (u < state[HYST_JOINT_INPUT] || u > state[HYST_JOINT_INPUT]);
    hyst_real *variance = state + at.scratch;
    hyst_real doubt = ZERO;
    for (size_t i = 0; i < joint->plays; ++i) {
        move_play(joint, &at, state, i, u, v);
    }
    hyst_ud_variances(at.m, state + at.u, state + at.d, variance);
    const hyst_real error = y - predict(joint, &at, state, u, v, variance, &doubt);
    watch_range(joint, state, v, started);
    state[HYST_JOINT_INPUT] = u;
    state[HYST_JOINT_STARTED] = ONE;
    if (moves) {
        forget(joint, &at, state, state + at.scratch + at.m, variance);
    }
    const int done = measure(joint, &at, state, error, doubt);
    set_memory(joint, &at, state, u);
    if (!done) {
        state[HYST_JOINT_REFUSED] += ONE;
        return HYST_JOINT_WAS_REFUSED;
    }
    state[HYST_JOINT_ERROR] = error;
    return HYST_JOINT_UPDATED;
}
