#include "check.h"

#define NO_MAP {0, 0, NULL, R(0.0), R(0.0)}
#define STATE_ROOM 700

static const hyst_real limit[] = {R(0.1), R(0.1), R(0.1), R(0.2), R(0.2), R(1.0)};

static hyst_joint two_plays(void)
{
    const hyst_joint joint = {2,       NO_MAP,  NO_MAP,   R(1e-3), R(10.0),  R(5.0),   R(0.0),
                              R(200.0), R(1e-12), R(1e-6), R(2000.0), limit};
    return joint;
}

static void start(const hyst_joint *joint, hyst_real *state, const hyst_real *theta, hyst_real noise)
{
    const hyst_joint_layout at = hyst_joint_places(joint);
    CHECK(at.length <= STATE_ROOM);
    for (size_t j = 0; j < at.m; ++j) {
        state[at.theta + j] = theta[j];
    }
    for (size_t i = 0; i < joint->plays; ++i) {
        state[at.z + i] = R(0.0);
    }
    hyst_joint_start(joint, state, noise);
}

/* A triangle of 200 samples from -4 to 4 and back. */
static hyst_real triangle(size_t k)
{
    const size_t place = k % 200;
    const size_t way = place < 100 ? place : 200 - place;
    return R(0.08) * (hyst_real)way - R(4.0);
}

static void finds_weights_radii_and_offset(void)
{
    const hyst_real p[] = {R(0.5), R(0.25)};
    const hyst_real r[] = {R(0.5), R(1.5)};
    const hyst_pi truth = {2, R(1.0), p, r};
    const hyst_real wrong[] = {R(0.8), R(0.4), R(0.35), R(0.75), R(1.8), R(0.2)};
    const double right[] = {1.0, 0.5, 0.25, 0.5, 1.5, 0.0};
    const hyst_joint joint = two_plays();
    const hyst_joint_layout at = hyst_joint_places(&joint);
    hyst_real state[STATE_ROOM];
    hyst_real z[] = {R(0.0), R(0.0)};
    start(&joint, state, wrong, R(0.1));
    for (size_t k = 0; k < 4000; ++k) {
        const hyst_real u = triangle(k);
        CHECK(hyst_joint_step(&joint, state, u, hyst_pi_step(&truth, z, u)) == HYST_JOINT_UPDATED);
    }
    for (size_t j = 0; j < at.m; ++j) {
        /* Without noise only the start is left, or in float the rounding of y: 4000 samples of
         * 5 eps, over a gradient of the radii of 0.25. */
        CHECK_NEAR((double)state[at.theta + j], right[j], sizeof(hyst_real) == 8 ? 1e-5 : 5e-4);
    }
    for (size_t i = 0; i < 2; ++i) {
        CHECK_NEAR((double)state[at.z + i], (double)z[i], 5e-4);
    }
}

/* A held parameter keeps its bits. */
static void what_is_held_stays(void)
{
    const hyst_real held[] = {R(0.1), R(0.0), R(0.1), R(0.2), R(0.0), R(0.0)};
    const hyst_real theta[] = {R(0.8), R(0.4), R(0.35), R(0.75), R(1.8), R(0.2)};
    hyst_joint joint = two_plays();
    const hyst_joint_layout at = hyst_joint_places(&joint);
    hyst_real state[STATE_ROOM];
    joint.limit = held;
    joint.forgetting = R(0.01);
    start(&joint, state, theta, R(0.1));
    for (size_t k = 0; k < 1000; ++k) {
        hyst_joint_step(&joint, state, triangle(k), R(1.3) * triangle(k));
    }
    CHECK_EQUAL(state[at.theta + 1], theta[1]);
    CHECK_EQUAL(state[at.theta + 4], theta[4]);
    CHECK_EQUAL(state[at.theta + 5], theta[5]);
    CHECK(state[at.theta + 3] < theta[3] || state[at.theta + 3] > theta[3]);
}

static void check_invertible(const hyst_joint *joint, const hyst_real *state)
{
    const hyst_joint_layout at = hyst_joint_places(joint);
    const hyst_real *theta = state + at.theta;
    const hyst_real *z = state + at.z;
    double sum = 0.0;
    int finite = 1;
    for (size_t i = 0; i < at.psi; ++i) {
        finite = finite && hyst_is_finite(state[i]);
    }
    CHECK(finite);
    for (size_t i = 0; i <= joint->plays; ++i) {
        sum += (double)theta[i];
        CHECK(sum > 0.5e-3);
    }
    CHECK(theta[3] >= R(0.0));
    CHECK(theta[4] >= theta[3]);
    CHECK(theta[4] <= R(5.0));
    /* Clamped to a step between radii, each of them rounded. */
    CHECK(fabs((double)(z[1] - z[0])) <=
          (double)(theta[4] - theta[3]) + 4.0 * (double)REAL_EPSILON * (1.0 + fabs((double)z[0])));
}

/* Noise, jumps, rest, a stuck output, infinities, NaN, numbers beyond all measure. */
static void every_estimate_can_be_inverted(void)
{
    enum { samples = 20000 };
    static hyst_real noise[2 * samples];
    const hyst_real theta[] = {R(0.8), R(0.4), R(0.35), R(0.75), R(1.8), R(0.2)};
    hyst_joint joint = two_plays();
    hyst_real state[STATE_ROOM];
    joint.forgetting = R(0.01);
    fill_with_noise(noise, 2 * samples, R(3.0));
    start(&joint, state, theta, R(0.1));
    size_t bad = 0;
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
        bad += !hyst_is_finite(y);
        hyst_joint_step(&joint, state, u, y);
        check_invertible(&joint, state);
    }
    CHECK_EQUAL(state[HYST_JOINT_SKIPPED], (hyst_real)bad);
    CHECK(state[HYST_JOINT_REFUSED] > R(0.0));
    CHECK(state[HYST_JOINT_UPDATES] > R(0.9) * (hyst_real)samples);
}

/* At rest nothing is forgotten, and in motion nothing beyond the variances of the start. */
static void variances_do_not_wind_up(void)
{
    const hyst_real theta[] = {R(0.8), R(0.4), R(0.35), R(0.75), R(1.8), R(0.2)};
    hyst_joint joint = two_plays();
    const hyst_joint_layout at = hyst_joint_places(&joint);
    hyst_real state[STATE_ROOM];
    hyst_real variance[6];
    joint.forgetting = R(0.05);
    start(&joint, state, theta, R(0.1));
    for (size_t k = 0; k < 30000; ++k) {
        const hyst_real u = k % 10000 < 5000 ? triangle(k) : R(0.01) * (hyst_real)(k % 2);
        hyst_joint_step(&joint, state, u, u);
    }
    hyst_ud_variances(at.m, state + at.u, state + at.d, variance);
    for (size_t j = 0; j < at.m; ++j) {
        CHECK((double)variance[j] <= 1.001 * (double)limit[j]);
    }
    for (size_t j = at.d; j < at.z; ++j) {
        CHECK(hyst_is_finite(state[j]));
    }
}

/* Stopped, copied and continued it gives the same bits. */
static void goes_on_from_a_copy(void)
{
    const hyst_real theta[] = {R(0.8), R(0.4), R(0.35), R(0.75), R(1.8), R(0.2)};
    const hyst_joint joint = two_plays();
    const hyst_joint_layout at = hyst_joint_places(&joint);
    hyst_real whole[STATE_ROOM];
    hyst_real parts[STATE_ROOM];
    start(&joint, whole, theta, R(0.1));
    for (size_t k = 0; k < 1000; ++k) {
        if (k == 333) {
            memcpy(parts, whole, sizeof parts);
        }
        hyst_joint_step(&joint, whole, triangle(k), R(1.5) * triangle(k));
    }
    for (size_t k = 333; k < 1000; ++k) {
        hyst_joint_step(&joint, parts, triangle(k), R(1.5) * triangle(k));
    }
    CHECK_SAME_BITS(parts, whole, at.psi);
}

int main(void)
{
    finds_weights_radii_and_offset();
    what_is_held_stays();
    every_estimate_can_be_inverted();
    variances_do_not_wind_up();
    goes_on_from_a_copy();
    return check_result();
}
