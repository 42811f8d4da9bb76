#include "check.h"

static const hyst_real limit[] = {R(1.0), R(1.0), R(1.0), R(1.0), R(1.0), R(1.0), R(1.0), R(1.0)};
static const hyst_real knee[] = {R(0.0), R(1.0)};

static hyst_joint bank(size_t front_terms)
{
    hyst_joint joint = {2, {0, 0, NULL, R(0.1), R(9.0)}, {0, 0, NULL, R(0.1), R(9.0)}, R(0.1), R(9.0),
                        R(9.0), R(0.0), R(100.0), R(1e-9), R(0.0), R(100.0), limit};
    joint.front.count = front_terms;
    joint.front.positive = front_terms == 2;
    joint.front.threshold = knee;
    return joint;
}

static void start(const hyst_joint *joint, hyst_real *state, const hyst_real *theta)
{
    const hyst_joint_layout at = hyst_joint_places(joint);
    for (size_t j = 0; j < at.m; ++j) {
        state[at.theta + j] = theta[j];
    }
    state[at.z] = state[at.z + 1] = R(0.0);
    hyst_joint_start(joint, state, R(1.0));
}

/* With radii that are certain it is the chain of dead zone and plays, and nothing is in doubt. */
static void certain_radii_give_the_operator(void)
{
    enum { samples = 2000 };
    static hyst_real u[samples];
    static const hyst_real none[8] = {R(0.0)};
    const hyst_real theta[] = {R(0.5), R(0.25), R(1.0), R(0.5), R(1.25), R(0.0), R(2.0), R(-0.5)};
    const hyst_joint joint = bank(2);
    const hyst_joint_layout at = hyst_joint_places(&joint);
    const hyst_pi pi = {2, theta[0], theta + 1, theta + 3};
    const hyst_dead_zone front = {2, theta + 6, knee};
    hyst_real z[] = {R(0.0), R(0.0)};
    hyst_real state[400];
    CHECK(at.length <= COUNT(state));
    start(&joint, state, theta);
    fill_with_noise(u, samples, R(2.0));
    for (size_t k = 0; k < samples; ++k) {
        hyst_real doubt = R(1.0);
        const hyst_real y = hyst_pi_step(&pi, z, hyst_dead_zone_step(&front, u[k]));
        hyst_joint_follow(&joint, &at, state, u[k]);
        const hyst_real predicted = hyst_joint_predict(&joint, &at, state, u[k], none, &doubt);
        hyst_joint_set_memory(&joint, &at, state, u[k]);
        /* Some ten operations on numbers below 10. */
        CHECK_NEAR((double)predicted, (double)y, 100.0 * (double)REAL_EPSILON);
        CHECK_NEAR((double)state[at.z], (double)z[0], 100.0 * (double)REAL_EPSILON);
        CHECK_NEAR((double)state[at.z + 1], (double)z[1], 100.0 * (double)REAL_EPSILON);
        CHECK_EQUAL(doubt, R(0.0));
    }
}

/* By hand, no maps. p = (1, 2), r = (1, 2), p0 = 0.5. Up to 6: both plays on the lower envelope,
 * z = 5, 4. Down to 3: the first on the upper, z = 4; the second still where it was.
 * y = 1.5 + 4 + 8; dy/dr = (+1, -2). */
static void gradient_by_hand(void)
{
    static const hyst_real none[8] = {R(0.0)};
    const hyst_real theta[] = {R(0.5), R(1.0), R(2.0), R(1.0), R(2.0), R(0.25)};
    const hyst_real expected[] = {R(3.0), R(4.0), R(4.0), R(1.0), R(-2.0), R(1.0)};
    const hyst_joint joint = bank(0);
    const hyst_joint_layout at = hyst_joint_places(&joint);
    hyst_real state[400];
    hyst_real doubt;
    start(&joint, state, theta);
    hyst_joint_follow(&joint, &at, state, R(6.0));
    hyst_joint_set_memory(&joint, &at, state, R(6.0));
    hyst_joint_follow(&joint, &at, state, R(3.0));
    CHECK_EQUAL(hyst_joint_predict(&joint, &at, state, R(3.0), none, &doubt), R(13.75));
    CHECK_SAME_BITS(state + at.psi, expected, COUNT(expected));
}

/* A radius of 2 +- w / sqrt(3), w = 2, where the play is just about to reach its other envelope
 * (x = 0): z lies a quarter of w beyond the anchor's, the slope of h is 1/2, and the doubt is
 * w^2 (1/8 (4 - 3/2) - 1/4) / 3 = w^2 / 48. */
static void uncertain_radius_softens_the_change_of_envelope(void)
{
    const hyst_real variance[] = {R(0.0), R(0.0), R(0.0), R(0.0),
                                  (hyst_real)(1.0 / 3.0), R(0.0)};
    const hyst_real theta[] = {R(0.5), R(1.0), R(2.0), R(1.0), R(2.0), R(0.0)};
    const hyst_joint joint = bank(0);
    const hyst_joint_layout at = hyst_joint_places(&joint);
    hyst_real state[400];
    hyst_real doubt;
    start(&joint, state, theta);
    hyst_joint_follow(&joint, &at, state, R(6.0));
    hyst_joint_set_memory(&joint, &at, state, R(6.0));
    hyst_joint_follow(&joint, &at, state, R(2.0));
    hyst_joint_predict(&joint, &at, state, R(2.0), variance, &doubt);
    const double tolerance = 20.0 * (double)REAL_EPSILON;
    CHECK_NEAR((double)state[at.psi + 2], 4.0 - 0.5, tolerance); /* z */
    CHECK_NEAR((double)state[at.psi + 4], 0.0, tolerance);
    CHECK_NEAR((double)doubt, 4.0 * 4.0 / 48.0, tolerance);
}

int main(void)
{
    certain_radii_give_the_operator();
    gradient_by_hand();
    uncertain_radius_softens_the_change_of_envelope();
    return check_result();
}
