/* The set of models that can be inverted, and the way back into it. */
#include "hyst/finite.h"
#include "hyst/isotonic.h"
#include "hyst/joint_parts.h"
#include "hyst/play.h"
#include "hyst/ud_factor.h"

#define ZERO HYST_REAL(0.0)
#define ONE HYST_REAL(1.0)

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
    if (map->count == 0u) {
        return;
    }
    const size_t negative = map->count - 1u - map->positive;
    keep_rising(1, ZERO, weight, map->least_slope, map->most_slope);
    keep_rising(map->positive, weight[0], weight + 1, map->least_slope, map->most_slope);
    keep_rising(negative, weight[0], weight + 1u + map->positive, map->least_slope,
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
    const inequality order = {k, k, k == n + 1u ? k : k - 1u, ZERO, joint->most_radius};
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

void hyst_joint_project(const hyst_joint *joint, const hyst_joint_layout *at,
                        hyst_real *theta, hyst_real *a, hyst_real *product)
{
    const size_t count = 2u * joint->plays + 1u;
    size_t left = HYST_JOINT_PROJECTIONS;
    for (size_t k = 0; k < count && left > 0u; ++k) {
        left -= (size_t)satisfy(at, inequality_of(joint, k), theta, a, product);
    }
}

void hyst_joint_clamp(const hyst_joint *joint, hyst_real *theta)
{
    const size_t n = joint->plays;
    hyst_real *front = theta + 2u + 2u * n;
    keep_rising(n + 1u, ZERO, theta, joint->least_slope, joint->most_slope);
    hyst_isotonic(n, theta + 1u + n, ZERO, joint->most_radius);
    keep_map_rising(&joint->front, front);
    keep_map_rising(&joint->back, front + joint->front.count);
}
