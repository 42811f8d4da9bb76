/* The command of an estimate: its inverse, formed as it is needed. */
#include "hyst/joint_parts.h"
#include "hyst/play.h"

#define ZERO HYST_REAL(0.0)

/* Terms first .. last of a map, all on one side, after its linear one. */
static hyst_real unmap_side(const hyst_joint_map *map, const hyst_real *weight, size_t first,
                            size_t last, hyst_real y)
{
    hyst_real slope = weight[0];
    hyst_real x = ZERO;
    hyst_real at = ZERO;
    for (size_t j = first; j < last; ++j) {
        const hyst_real next = at + slope * (map->threshold[j] - x);
        if (y > ZERO ? y <= next : y >= next) {
            break;
        }
        at = next;
        x = map->threshold[j];
        slope += weight[j];
    }
    return x + (y - at) / slope;
}

static hyst_real unmap(const hyst_joint_map *map, const hyst_real *weight, hyst_real y)
{
    if (map->count == 0u) {
        return y;
    }
    return y > ZERO ? unmap_side(map, weight, 1u, 1u + map->positive, y)
                    : unmap_side(map, weight, 1u + map->positive, map->count, y);
}

hyst_real hyst_joint_command(const hyst_joint *joint, const hyst_real *state, hyst_real y_ref)
{
    const hyst_joint_layout at = hyst_joint_places(joint);
    const size_t n = joint->plays;
    const hyst_real *theta = state + at.theta;
    const hyst_real *p = theta + 1;
    const hyst_real *r = p + n;
    const hyst_real *z = state + at.z;
    const hyst_real *front = theta + 2u + 2u * n;
    const hyst_real w = unmap(&joint->back, front + joint->front.count, y_ref - theta[1u + 2u * n]);
    hyst_real beyond = ZERO; /* sum of p_i z_i over the plays that are still to come */
    for (size_t i = 0; i < n; ++i) {
        beyond += p[i] * z[i];
    }
    hyst_real slope = theta[0];
    hyst_real threshold = ZERO;
    hyst_real v = w / slope;
    for (size_t i = 0; i < n; ++i) {
        const hyst_real next = slope + p[i];
        threshold += slope * (r[i] - (i > 0u ? r[i - 1u] : ZERO));
        beyond -= p[i] * z[i];
        v -= p[i] / slope / next * hyst_play(w, threshold, next * z[i] + beyond);
        slope = next;
    }
    return unmap(&joint->front, front, v);
}
