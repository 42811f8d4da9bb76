#include "check.h"

static const hyst_real limit[] = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0),
                                  R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
static const hyst_real front_knee[] = {R(0.0), R(1.0), R(-1.5)};
static const hyst_real back_knee[] = {R(0.0), R(0.5), R(2.0)};

/* The command, applied to the model whose memory the state holds, gives the reference. */
static void command_gives_the_reference(void)
{
    enum { samples = 2000 };
    static hyst_real y_ref[samples];
    const hyst_joint joint = {2, {3, 1, front_knee, R(0.1), R(9.0)}, {3, 2, back_knee, R(0.1), R(9.0)},
                              R(0.1), R(9.0), R(9.0), R(0.0), R(100.0), R(1e-9), R(0.0), R(100.0),
                              limit};
    const hyst_real theta[] = {R(0.5), R(0.75), R(-0.25), R(0.5), R(1.25), R(0.5),
                               R(1.0), R(0.5),  R(-0.5),  R(2.0), R(-0.5), R(0.25)};
    const hyst_joint_layout at = hyst_joint_places(&joint);
    const hyst_pi pi = {2, theta[0], theta + 1, theta + 3};
    const hyst_dead_zone front = {3, theta + 6, front_knee};
    const hyst_dead_zone back = {3, theta + 9, back_knee};
    hyst_real z[] = {R(0.0), R(0.0)};
    hyst_real state[900];
    CHECK(at.length <= COUNT(state));
    CHECK(at.m == COUNT(theta));
    memcpy(state + at.theta, theta, sizeof theta);
    state[at.z] = state[at.z + 1] = R(0.0);
    hyst_joint_start(&joint, state, R(1.0));
    fill_with_noise(y_ref, samples, R(6.0));
    for (size_t k = 0; k < samples; ++k) {
        const hyst_real u = hyst_joint_command(&joint, state, y_ref[k]);
        const hyst_real v = hyst_dead_zone_step(&front, u);
        const hyst_real y = hyst_dead_zone_step(&back, hyst_pi_step(&pi, z, v)) + theta[5];
        /* Slopes down to 0.375 and numbers below 20, some thirty operations. */
        CHECK_NEAR((double)y, (double)y_ref[k], 2000.0 * (double)REAL_EPSILON);
        hyst_joint_step(&joint, state, u, y);
    }
}

int main(void)
{
    command_gives_the_reference();
    return check_result();
}
