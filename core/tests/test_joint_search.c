#include "check.h"

#define NO_MAP {0, 0, NULL, R(0.0), R(0.0)}
#define CELLS 12
#define STATE_ROOM 600

/* p0, p_1, p_2, r_1, r_2, offset. */
static const hyst_real limit[] = {R(0.1), R(0.1), R(0.1), R(0.2), R(0.2), R(1.0)};
static const hyst_real cell_radius[CELLS] = {R(0.25), R(0.35), R(0.45), R(0.6), R(0.75), R(0.95),
                                             R(1.2),  R(1.5),  R(1.9),  R(2.4), R(3.0),  R(3.8)};
static hyst_real cell_start[CELLS + 2];
static hyst_real cell_limit[CELLS + 2];

static hyst_joint two_plays(void)
{
    const hyst_joint joint = {2,        NO_MAP,   NO_MAP,  R(1e-3),   R(10.0), R(5.0), R(0.0),
                              R(200.0), R(1e-12), R(1e-6), R(2000.0), limit};
    return joint;
}

static hyst_search search_of(const hyst_joint *joint, size_t cells)
{
    const hyst_search search = {joint, cells, cell_radius, cell_start, cell_limit, R(1e-4)};
    for (size_t j = 0; j < CELLS + 2; ++j) {
        cell_start[j] = R(0.06);
        cell_limit[j] = R(4.0);
    }
    cell_start[0] = R(0.9);
    cell_start[CELLS + 1] = R(0.0);
    return search;
}

static void start(const hyst_search *search, hyst_real *state, const hyst_real *theta)
{
    const hyst_search_layout at = hyst_search_places(search);
    CHECK(at.length <= STATE_ROOM);
    for (size_t j = 0; j < at.joint.m; ++j) {
        state[at.joint.theta + j] = theta[j];
    }
    for (size_t i = 0; i < search->joint->plays; ++i) {
        state[at.joint.z + i] = R(0.0);
    }
    hyst_joint_start(search->joint, state, R(0.1));
    hyst_search_start(search, state);
}

/* A triangle of 400 samples from -9 to 9 and back. */
static hyst_real triangle(size_t k)
{
    const size_t place = k % 400;
    const size_t way = place < 200 ? place : 400 - place;
    return R(0.09) * (hyst_real)way - R(9.0);
}

/* Both radii start near the first true one, which leaves nothing to find the second by. */
static void leaves_a_false_minimum(void)
{
    const hyst_real p[] = {R(0.5), R(0.4)};
    const hyst_real r[] = {R(0.5), R(3.2)};
    const hyst_pi truth = {2, R(1.0), p, r};
    const hyst_real wrong[] = {R(1.0), R(0.05), R(0.2), R(0.1), R(0.15), R(0.0)};
    const double right[] = {1.0, 0.5, 0.4, 0.5, 3.2, 0.0};
    static const hyst_real narrow[] = {R(0.01), R(0.01), R(0.01), R(1e-4), R(1e-4), R(0.01)};
    hyst_joint joint = two_plays();
    hyst_real state[STATE_ROOM];
    joint.limit = narrow;
    for (size_t cells = 0; cells <= CELLS; cells += CELLS) {
        const hyst_search search = search_of(&joint, cells);
        const hyst_search_layout at = hyst_search_places(&search);
        hyst_real z[] = {R(0.0), R(0.0)};
        start(&search, state, wrong);
        for (size_t k = 0; k < 4000; ++k) {
            const hyst_real u = triangle(k);
            hyst_search_step(&search, state, u, hyst_pi_step(&truth, z, u));
        }
        const hyst_real correlation = hyst_search_correlation(&search, state);
        if (cells == 0) {
            /* The start is far too sure of itself, and its errors say so. */
            CHECK(correlation > R(0.9));
            CHECK(state[at.joint.theta + 4] < R(2.0));
        } else {
            CHECK(state[at.scalars + HYST_SEARCH_REPLACEMENTS] >= R(1.0));
            for (size_t j = 0; j < at.joint.m; ++j) {
                /* What is left of the rival's start after 3000 samples, or in float the rounding. */
                CHECK_NEAR((double)state[at.joint.theta + j], right[j],
                           sizeof(hyst_real) == 8 ? 1e-3 : 1e-2);
            }
        }
    }
}

/* An estimate that is right keeps its bits: the search changes nothing but replaces it. */
static void does_not_disturb_what_is_right(void)
{
    const hyst_real theta[] = {R(1.0), R(0.5), R(0.4), R(0.5), R(3.2), R(0.0)};
    const hyst_pi truth = {2, R(1.0), theta + 1, theta + 3};
    const hyst_joint joint = two_plays();
    const hyst_search with = search_of(&joint, CELLS);
    const hyst_search without = search_of(&joint, 0);
    const hyst_search_layout at = hyst_search_places(&with);
    hyst_real searched[STATE_ROOM];
    hyst_real alone[STATE_ROOM];
    static hyst_real noise[4000];
    hyst_real z[] = {R(0.0), R(0.0)};
    fill_with_noise(noise, 4000, R(0.05));
    start(&with, searched, theta);
    start(&without, alone, theta);
    for (size_t k = 0; k < 4000; ++k) {
        const hyst_real u = triangle(k);
        const hyst_real y = hyst_pi_step(&truth, z, u) + noise[k];
        hyst_search_step(&with, searched, u, y);
        hyst_search_step(&without, alone, u, y);
    }
    CHECK(searched[at.scalars + HYST_SEARCH_TRIALS] >= R(1.0));
    CHECK_EQUAL(searched[at.scalars + HYST_SEARCH_REPLACEMENTS], R(0.0));
    CHECK_SAME_BITS(searched, alone, at.joint.psi);
    /* White noise: of 200 samples fading out the correlation is 0 to within 0.05, five of it. */
    const hyst_real correlation = hyst_search_correlation(&with, searched);
    CHECK(correlation < R(0.25) && correlation > R(-0.25));
}

/* A plant no two plays make: eight of them and a parabola. Errors then follow each other, and a
 * rival that is better by a little is so by luck: the bits of the estimate stay. */
static void does_not_trust_errors_that_follow_each_other(void)
{
    static const hyst_real p[] = {R(0.12), R(0.12), R(0.12), R(0.12),
                                  R(0.12), R(0.12), R(0.12), R(0.12)};
    static const hyst_real r[] = {R(0.3), R(0.76), R(1.2), R(1.7), R(2.1), R(2.6), R(3.0), R(3.5)};
    const hyst_pi truth = {8, R(1.0), p, r};
    const hyst_real theta[] = {R(1.0), R(0.4), R(0.5), R(0.6), R(2.4), R(0.0)};
    hyst_joint joint = two_plays();
    joint.forgetting = R(1e-3);
    const hyst_search with = search_of(&joint, CELLS);
    const hyst_search without = search_of(&joint, 0);
    const hyst_search_layout at = hyst_search_places(&with);
    hyst_real searched[STATE_ROOM];
    hyst_real alone[STATE_ROOM];
    hyst_real z[8] = {R(0.0)};
    start(&with, searched, theta);
    start(&without, alone, theta);
    for (size_t k = 0; k < 12000; ++k) {
        const hyst_real u = triangle(2 * k);
        const hyst_real y = hyst_pi_step(&truth, z, u) + R(0.02) * u * u;
        hyst_search_step(&with, searched, u, y);
        hyst_search_step(&without, alone, u, y);
    }
    CHECK(hyst_search_correlation(&with, searched) > R(0.5));
    CHECK(searched[at.scalars + HYST_SEARCH_TRIALS] >= R(2.0));
    CHECK_EQUAL(searched[at.scalars + HYST_SEARCH_REPLACEMENTS], R(0.0));
    CHECK_SAME_BITS(searched, alone, at.joint.psi);
}

/* Two neighbours become one of their weight and mean radius, the cheapest union first. */
static void merges_the_cheapest_neighbours(void)
{
    const hyst_joint joint = two_plays();
    hyst_search search = search_of(&joint, 4);
    static const hyst_real radius[] = {R(1.0), R(2.0), R(3.0), R(8.0)};
    hyst_real state[STATE_ROOM];
    const hyst_real theta[] = {R(1.0), R(0.5), R(0.4), R(0.5), R(3.2), R(0.0)};
    search.radius = radius;
    const hyst_search_layout at = hyst_search_places(&search);
    start(&search, state, theta);
    state[at.weight + 1] = R(1.0);
    state[at.weight + 2] = R(0.25);
    state[at.weight + 3] = R(0.75);
    state[at.weight + 4] = R(0.5);
    hyst_cells_begin_merging(&search, &at, state);
    /* Heights by hand: 1 * 0.25 / 1.25 = 0.2, 0.25 * 0.75 / 1 = 0.1875, 0.75 * 0.5 / 1.25 * 5 = 1.5;
     * their squares times the gaps 1, 1 and 5. */
    CHECK_NEAR((double)state[at.point_cost], 0.04, 1e-7);
    CHECK_NEAR((double)state[at.point_cost + 1], 0.03515625, 1e-7);
    CHECK_NEAR((double)state[at.point_cost + 2], 11.25, 1e-5);
    hyst_cells_merge(&at, state);
    CHECK_EQUAL(state[at.scalars + HYST_SEARCH_COUNT], R(3.0));
    CHECK_NEAR((double)state[at.point_weight + 1], 1.0, 1e-6);
    CHECK_NEAR((double)state[at.point_radius + 1], 2.75, 1e-6);
    CHECK_NEAR((double)state[at.point_radius + 2], 8.0, 1e-6);
    hyst_cells_merge(&at, state);
    /* 1 and 1 at 1 and 2.75: (0.5 * 1.75)^2 * 1.75 = 1.3, less than (0.5 / 1.5 * 5.25)^2 * 5.25 = 16. */
    CHECK_NEAR((double)state[at.point_weight], 2.0, 1e-6);
    CHECK_NEAR((double)state[at.point_radius], 1.875, 1e-6);
    /* A negative weight joins its neighbour for nothing, and takes the radius nowhere else. */
    state[at.weight + 3] = R(-0.05);
    hyst_cells_begin_merging(&search, &at, state);
    CHECK_EQUAL(state[at.point_cost + 1], R(0.0));
    hyst_cells_merge(&at, state);
    CHECK_NEAR((double)state[at.point_weight + 1], 0.2, 1e-6);
    CHECK_EQUAL(state[at.point_radius + 1], R(2.0));
}

/* Noise, rest, jumps, NaN and numbers beyond all measure leave nothing that is not finite. */
static void stays_finite(void)
{
    enum { samples = 40000 };
    static hyst_real noise[2 * samples];
    const hyst_real theta[] = {R(0.8), R(0.4), R(0.35), R(0.75), R(1.8), R(0.2)};
    hyst_joint joint = two_plays();
    joint.forgetting = R(0.01);
    const hyst_search search = search_of(&joint, CELLS);
    const hyst_search_layout at = hyst_search_places(&search);
    hyst_real state[STATE_ROOM];
    fill_with_noise(noise, 2 * samples, R(3.0));
    start(&search, state, theta);
    for (size_t k = 0; k < samples; ++k) {
        hyst_real u = noise[2 * k];
        hyst_real y = noise[2 * k + 1];
        const size_t kind = k / 500 % 8;
        u = kind == 1 ? R(1.0) : u;
        y = kind == 2 ? R(2.0) : y;
        u = kind == 3 ? (k % 100 < 50 ? R(4.0) : R(-4.0)) : u;
        y = kind == 4 && k % 7 == 0 ? (hyst_real)NAN : y;
        u = kind == 5 && k % 50 == 0 ? REAL_MAX : u;
        y = kind == 6 && k % 50 == 0 ? -REAL_MAX : y;
        y = kind == 7 ? R(-2.0) * u : y;
        hyst_search_step(&search, state, u, y);
        int finite = 1;
        for (size_t i = 0; i < at.joint.psi; ++i) {
            finite = finite && hyst_is_finite(state[i]);
        }
        for (size_t i = at.scalars; i < at.rival + at.joint.psi; ++i) {
            finite = finite && hyst_is_finite(state[i]);
        }
        for (size_t i = at.weight; i < at.scratch; ++i) {
            finite = finite && hyst_is_finite(state[i]);
        }
        CHECK(finite);
    }
    CHECK(state[at.scalars + HYST_SEARCH_TRIALS] > R(1.0));
}

int main(void)
{
    leaves_a_false_minimum();
    does_not_disturb_what_is_right();
    does_not_trust_errors_that_follow_each_other();
    merges_the_cheapest_neighbours();
    stays_finite();
    return check_result();
}
