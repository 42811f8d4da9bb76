/* What an estimate predicts, how that depends on its parameters, and the memory that goes with it. */
#include "hyst/joint_parts.h"
#include "hyst/play.h"
#include "hyst/power.h"

#define ZERO HYST_REAL(0.0)
#define ONE HYST_REAL(1.0)

hyst_real hyst_joint_term(hyst_real x, hyst_real rho)
{
    if (rho > ZERO) {
        return x > rho ? x - rho : ZERO;
    }
    if (rho < ZERO) {
        return x < rho ? x - rho : ZERO;
    }
    return x;
}

hyst_real hyst_joint_map_at(const hyst_joint_map *map, const hyst_real *weight, hyst_real x)
{
    hyst_real y = map->count == 0u ? x : ZERO;
    for (size_t j = 0; j < map->count; ++j) {
        y += weight[j] * hyst_joint_term(x, map->threshold[j]);
    }
    return y;
}

hyst_real hyst_joint_map_slope(const hyst_joint_map *map, const hyst_real *weight, hyst_real x)
{
    hyst_real slope = map->count == 0u ? ONE : ZERO;
    for (size_t j = 0; j < map->count; ++j) {
        const hyst_real rho = map->threshold[j];
        const int acts = rho > ZERO ? x > rho : !(rho < ZERO) || x < rho;
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
    return hyst_joint_map_at(&joint->front, theta + 2u + 2u * joint->plays, u);
}

/* Follows the way of play i: home and far end, as inputs u. */
static void move_play(const hyst_joint *joint, const hyst_joint_layout *at, hyst_real *state,
                      size_t i, hyst_real u, hyst_real v)
{
    const hyst_real *theta = state + at->theta;
    const hyst_real r = theta[1u + joint->plays + i];
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

void hyst_joint_follow(const hyst_joint *joint, const hyst_joint_layout *at, hyst_real *state,
                       hyst_real u)
{
    const hyst_real v = front_at(joint, state + at->theta, u);
    for (size_t i = 0; i < joint->plays; ++i) {
        move_play(joint, at, state, i, u, v);
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
    hyst_real *by_front = psi + 2u + 2u * n;
    hyst_real w = theta[0] * v;
    psi[0] = v;
    for (size_t j = 0; j < joint->front.count; ++j) {
        by_front[j] = theta[0] * hyst_joint_term(u, joint->front.threshold[j]);
    }
    for (size_t i = 0; i < n; ++i) {
        const hyst_real p = theta[1u + i];
        const hyst_real r = theta[1u + n + i];
        const hyst_real of_r = variance[1u + n + i];
        const hyst_real side = state[at->side + i];
        const hyst_real home = state[at->home + i];
        const hyst_real far = state[at->far + i];
        regime is = {state[at->z + i], ZERO, ZERO, ZERO, ZERO};
        if (side > ZERO || side < ZERO) {
            const hyst_real width = hyst_power(HYST_REAL(12.0) * of_r, HYST_REAL(0.5));
            is = regime_of(front_at(joint, theta, home), front_at(joint, theta, far), side, r,
                           width);
        }
        psi[1u + i] = is.z;
        psi[1u + n + i] = p * is.by_r;
        w += p * is.z;
        *doubt += p * p * is.doubt + variance[1u + i] * of_r;
        for (size_t j = 0; j < joint->front.count; ++j) {
            const hyst_real rho = joint->front.threshold[j];
            by_front[j] += p * (is.by_home * hyst_joint_term(home, rho) + is.by_far * hyst_joint_term(far, rho));
        }
    }
    return w;
}

hyst_real hyst_joint_predict(const hyst_joint *joint, const hyst_joint_layout *at,
                             hyst_real *state, hyst_real u, const hyst_real *variance,
                             hyst_real *doubt)
{
    const size_t n = joint->plays;
    const size_t before_back = 2u + 2u * n + joint->front.count;
    const hyst_real *back = state + at->theta + before_back;
    hyst_real *psi = state + at->psi;
    const hyst_real v = front_at(joint, state + at->theta, u);
    *doubt = ZERO;
    const hyst_real w = predict_plays(joint, at, state, u, v, variance, doubt);
    const hyst_real slope = hyst_joint_map_slope(&joint->back, back, w);
    for (size_t j = 0; j < before_back; ++j) {
        psi[j] *= slope;
    }
    *doubt *= slope * slope;
    psi[1u + 2u * n] = ONE;
    for (size_t j = 0; j < joint->back.count; ++j) {
        psi[before_back + j] = hyst_joint_term(w, joint->back.threshold[j]);
    }
    return hyst_joint_map_at(&joint->back, back, w) + state[at->theta + 1u + 2u * n];
}

void hyst_joint_set_memory(const hyst_joint *joint, const hyst_joint_layout *at,
                           hyst_real *state, hyst_real u)
{
    const size_t n = joint->plays;
    const hyst_real *theta = state + at->theta;
    hyst_real *z = state + at->z;
    hyst_real from = front_at(joint, theta, u);
    hyst_real within = ZERO;
    for (size_t i = 0; i < n; ++i) {
        const hyst_real r = theta[1u + n + i];
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
