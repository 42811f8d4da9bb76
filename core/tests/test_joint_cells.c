#include "check.h"
#include "hyst/joint_parts.h"

#define NO_MAP {0, 0, NULL, R(0.0), R(0.0)}
#define STATE_ROOM 256

static const hyst_real radius[] = {R(1.0), R(2.0), R(3.0), R(4.0)};
static const hyst_real weight[] = {R(1.0), R(0.5), R(0.25), R(0.25), R(1.0), R(0.0)};
static const hyst_real ones[] = {R(1.0), R(1.0), R(1.0), R(1.0), R(1.0), R(1.0)};

static hyst_joint one_play(void)
{
    const hyst_joint joint = {1,        NO_MAP,   NO_MAP,  R(1e-3),   R(10.0), R(5.0), R(0.0),
                              R(200.0), R(1e-12), R(1e-6), R(2000.0), ones};
    return joint;
}

/* By hand: the prediction is 2 + 0.5, so with y = 3.5 the error is 1, and a = 2 + 4 + 1 + 1 = 8. */
static void one_measurement(void)
{
    const hyst_joint joint = one_play();
    const hyst_real start[] = {R(1.0), R(0.5), R(0.0)};
    const hyst_search search = {&joint, 1, radius, start, ones, R(2.0)};
    const hyst_search_layout at = hyst_search_places(&search);
    const double moved[] = {1.25, 0.625, 0.125};
    const double left[] = {0.5, 0.875, 0.875};
    const double forgotten[] = {0.605, 0.875, 0.875};
    hyst_real state[STATE_ROOM] = {R(0.0)};
    hyst_real variance[3];
    CHECK(at.length <= STATE_ROOM);
    hyst_cells_start(&search, &at, state);
    hyst_cells_follow(&search, &at, state, R(2.0));
    CHECK_EQUAL(state[at.z], R(1.0));
    hyst_cells_measure(&search, &at, state, R(2.0), R(3.5));
    hyst_ud_variances(3, state + at.u, state + at.d, variance);
    for (size_t j = 0; j < 3; ++j) {
        CHECK_NEAR((double)state[at.weight + j], moved[j], 8.0 * REAL_EPSILON);
        CHECK_NEAR((double)variance[j], left[j], 8.0 * REAL_EPSILON);
    }
    /* The square of the error is an eighth of what was foreseen; 20 samples count before the first. */
    CHECK_NEAR((double)state[at.scalars + HYST_SEARCH_NOISE], 2.0 * (1.0 - 0.875 / 20.0),
               8.0 * REAL_EPSILON);
    /* Growth of 1.1 would take the last two variances beyond 1, where they started. */
    state[at.scalars + HYST_SEARCH_GROWTH] = R(1.1);
    hyst_cells_forget(&search, &at, state);
    hyst_ud_variances(3, state + at.u, state + at.d, variance);
    for (size_t j = 0; j < 3; ++j) {
        CHECK_NEAR((double)variance[j], forgotten[j], 8.0 * REAL_EPSILON);
    }
    CHECK_EQUAL(state[at.scalars + HYST_SEARCH_GROWTH], R(1.0));
}

static void a_measurement_that_overflows_starts_anew(void)
{
    const hyst_joint joint = one_play();
    const hyst_search search = {&joint, 1, radius, weight, ones, R(2.0)};
    const hyst_search_layout at = hyst_search_places(&search);
    hyst_real state[STATE_ROOM] = {R(0.0)};
    hyst_cells_start(&search, &at, state);
    hyst_cells_measure(&search, &at, state, R(2.0), R(3.5));
    hyst_cells_measure(&search, &at, state, REAL_MAX, R(3.5));
    CHECK_SAME_BITS(state + at.weight, weight, 3);
    CHECK_SAME_BITS(state + at.d, ones, 3);
}

/* Unions lose h^2 gap for h = w_a w_b / (w_a + w_b) gap: 1/36, 1/64 and 1/25, then 0.2109375 and
 * 0.375. */
static void unites_what_loses_least(void)
{
    const hyst_joint joint = one_play();
    const hyst_search search = {&joint, 4, radius, weight, ones, R(1.0)};
    const hyst_search_layout at = hyst_search_places(&search);
    const double costs[] = {1.0 / 36.0, 1.0 / 64.0, 1.0 / 25.0};
    const hyst_real three_weights[] = {R(0.5), R(0.5), R(1.0)};
    const hyst_real three_radii[] = {R(1.0), R(2.5), R(4.0)};
    const hyst_real two_weights[] = {R(1.0), R(1.0)};
    const hyst_real two_radii[] = {R(1.75), R(4.0)};
    hyst_real state[STATE_ROOM] = {R(0.0)};
    CHECK(at.length <= STATE_ROOM);
    hyst_cells_start(&search, &at, state);
    hyst_cells_begin_merging(&search, &at, state);
    for (size_t k = 0; k < 3; ++k) {
        CHECK_NEAR((double)state[at.point_cost + k], costs[k], REAL_EPSILON);
    }
    hyst_cells_merge(&at, state);
    CHECK_EQUAL(state[at.scalars + HYST_SEARCH_COUNT], R(3.0));
    CHECK_SAME_BITS(state + at.point_weight, three_weights, 3);
    CHECK_SAME_BITS(state + at.point_radius, three_radii, 3);
    CHECK_NEAR((double)state[at.point_cost], 0.2109375, REAL_EPSILON);
    CHECK_NEAR((double)state[at.point_cost + 1], 0.375, REAL_EPSILON);
    hyst_cells_merge(&at, state);
    CHECK_EQUAL(state[at.scalars + HYST_SEARCH_COUNT], R(2.0));
    CHECK_SAME_BITS(state + at.point_weight, two_weights, 2);
    CHECK_SAME_BITS(state + at.point_radius, two_radii, 2);
}

/* A weight that noise made negative joins its neighbour first, which keeps its radius. */
static void a_negative_weight_joins_for_nothing(void)
{
    const hyst_joint joint = one_play();
    const hyst_real start[] = {R(1.0), R(0.5), R(0.25), R(-0.25), R(1.0), R(0.0)};
    const hyst_search search = {&joint, 4, radius, start, ones, R(1.0)};
    const hyst_search_layout at = hyst_search_places(&search);
    const hyst_real weights[] = {R(0.5), R(0.25), R(0.75)};
    const hyst_real radii[] = {R(1.0), R(2.0), R(4.0)};
    hyst_real state[STATE_ROOM] = {R(0.0)};
    hyst_cells_start(&search, &at, state);
    hyst_cells_begin_merging(&search, &at, state);
    CHECK_EQUAL(state[at.point_cost + 1], R(0.0));
    CHECK_EQUAL(state[at.point_cost + 2], R(0.0));
    state[at.point_cost + 1] = R(1.0); /* so that there is one least */
    hyst_cells_merge(&at, state);
    CHECK_SAME_BITS(state + at.point_weight, weights, 3);
    CHECK_SAME_BITS(state + at.point_radius, radii, 3);
}

int main(void)
{
    one_measurement();
    a_measurement_that_overflows_starts_anew();
    unites_what_loses_least();
    a_negative_weight_joins_for_nothing();
    return check_result();
}
