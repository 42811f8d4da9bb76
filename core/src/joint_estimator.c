/* Joint estimation of radii, weights, offset and maps: one sample. */
#include "hyst/joint_estimator.h"

#include "hyst/finite.h"
#include "hyst/joint_parts.h"
#include "hyst/play.h"
#include "hyst/ud_factor.h"

#define ZERO HYST_REAL(0.0)
#define ONE HYST_REAL(1.0)

size_t hyst_joint_parameters(const hyst_joint *joint)
{
    return 2u + 2u * joint->plays + joint->front.count + joint->back.count;
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
    at.length = at.scratch + 4u * at.m + hyst_ud_length(at.m);
    return at;
}

void hyst_joint_start(const hyst_joint *joint, hyst_real *state, hyst_real noise)
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
    const hyst_real forgotten = joint->forgetting;
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

/* Each error counts for at most HYST_JOINT_OUTLIER times what is usual. */
hyst_real hyst_joint_noise(const hyst_joint *joint, hyst_real noise, hyst_real seen,
                           hyst_real surprise)
{
    const hyst_real memory = seen + HYST_REAL(20.0);
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
    const size_t count = 2u * m + hyst_ud_length(m);
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
    hyst_joint_project(joint, at, theta, gain, f);
    if (!all_finite(theta, m)) {
        return 0;
    }
    hyst_joint_clamp(joint, theta);
    copy(state + at->theta, theta, count);
    state[HYST_JOINT_NOISE] =
        hyst_joint_noise(joint, state[HYST_JOINT_NOISE], state[HYST_JOINT_UPDATES], surprise);
    state[HYST_JOINT_VARIANCE] = a;
    state[HYST_JOINT_UPDATES] += ONE;
    return 1;
}

/* The range of v over the last samples that were used: an absurd one that is refused has no place in
 * it. */
static void watch_range(const hyst_joint *joint, hyst_real *state, hyst_real v)
{
    const int is_first = !(state[HYST_JOINT_UPDATES] > ONE);
    if (is_first || state[HYST_JOINT_BLOCK] >= joint->patience) {
        state[HYST_JOINT_LOW_BEFORE] = is_first ? v : state[HYST_JOINT_LOW];
        state[HYST_JOINT_HIGH_BEFORE] = is_first ? v : state[HYST_JOINT_HIGH];
        state[HYST_JOINT_LOW] = state[HYST_JOINT_HIGH] = v;
        state[HYST_JOINT_BLOCK] = ZERO;
    }
    state[HYST_JOINT_LOW] = v < state[HYST_JOINT_LOW] ? v : state[HYST_JOINT_LOW];
    state[HYST_JOINT_HIGH] = v > state[HYST_JOINT_HIGH] ? v : state[HYST_JOINT_HIGH];
    state[HYST_JOINT_BLOCK] += ONE;
}

hyst_joint_end hyst_joint_step(const hyst_joint *joint, hyst_real *state, hyst_real u, hyst_real y)
{
    const hyst_joint_layout at = hyst_joint_places(joint);
    const hyst_real *front = state + at.theta + 2u + 2u * joint->plays;
    const hyst_real v = hyst_is_finite(u) ? hyst_joint_map_at(&joint->front, front, u) : u;
    if (!hyst_is_finite(v) || !hyst_is_finite(y)) {
        state[HYST_JOINT_SKIPPED] += ONE;
        return HYST_JOINT_WAS_SKIPPED;
    }
    const int started = state[HYST_JOINT_STARTED] > ZERO;
    const int moves = started && (u < state[HYST_JOINT_INPUT] || u > state[HYST_JOINT_INPUT]);
    hyst_real *variance = state + at.scratch;
    hyst_real doubt = ZERO;
    hyst_joint_follow(joint, &at, state, u);
    hyst_ud_variances(at.m, state + at.u, state + at.d, variance);
    const hyst_real error = y - hyst_joint_predict(joint, &at, state, u, variance, &doubt);
    state[HYST_JOINT_INPUT] = u;
    state[HYST_JOINT_STARTED] = ONE;
    if (moves) {
        forget(joint, &at, state, state + at.scratch + at.m, variance);
    }
    const int done = measure(joint, &at, state, error, doubt);
    hyst_joint_set_memory(joint, &at, state, u);
    if (!done) {
        state[HYST_JOINT_REFUSED] += ONE;
        return HYST_JOINT_WAS_REFUSED;
    }
    watch_range(joint, state, v);
    state[HYST_JOINT_ERROR] = error;
    return HYST_JOINT_UPDATED;
}
