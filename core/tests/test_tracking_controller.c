/* The tracking controller against the difference equation worked out by hand, and against the same
 * made of the core's other parts. Most constants are powers of two, so nothing is rounded. */
#include "check.h"

/* PI controller, v = 2 e + 0.5 sum of earlier e; one state. */
static const hyst_real integrator[] = {R(1.0)};
static const hyst_real difference[] = {R(1.0), R(-1.0)}; /* e = y_ref - y */
static const hyst_real slow[] = {R(0.5)};

static hyst_tracking_controller pi_controller(void)
{
    const hyst_tracking_controller made = {
        1, integrator, difference, slow, {R(2.0), R(-2.0)}, {0, NULL}};
    return made;
}

static void test_by_hand(void)
{
    const hyst_tracking_controller controller = pi_controller();
    const hyst_real y_ref[] = {R(1.0), R(1.0), R(1.0), R(0.0)};
    const hyst_real y[] = {R(0.0), R(0.5), R(0.75), R(1.0)};
    /* e: 1, 0.5, 0.25, -1; sums before: 0, 1, 1.5, 1.75 */
    const hyst_real expected[] = {R(2.0), R(1.5), R(1.25), R(-1.125)};
    hyst_real state[1] = {R(0.0)};
    CHECK(hyst_tracking_controller_state_length(&controller) == 1);
    for (size_t k = 0; k < COUNT(expected); ++k) {
        CHECK_EQUAL(hyst_tracking_controller_step(&controller, state, y_ref[k], y[k]), expected[k]);
    }
    CHECK_EQUAL(state[0], R(0.75));
}

static const hyst_real p[] = {R(0.5), R(0.25)}, r[] = {R(1.0), R(2.0)};

static void test_inverse_follows_the_linear_part(void)
{
    const hyst_stage stages[] = {{&hyst_pi_kind, &(const hyst_pi){2, R(1.0), p, r}},
                                 {&hyst_affine_kind, &(const hyst_affine){R(0.5), R(1.0)}}};
    hyst_tracking_controller controller = pi_controller();
    controller.inverse.count = COUNT(stages);
    controller.inverse.stage = stages;
    hyst_real state[3] = {0}, x[1] = {0}, z[2] = {0}, y_ref[200], y[200];
    CHECK(hyst_tracking_controller_state_length(&controller) == 3);
    fill_with_noise(y_ref, COUNT(y_ref), R(3.0));
    fill_with_noise(y, COUNT(y), R(2.0));
    for (size_t k = 0; k < COUNT(y); ++k) {
        const hyst_real v = hyst_tracking_controller_linear(&controller, x, y_ref[k], y[k]);
        const hyst_real expected = hyst_chain_step(&controller.inverse, z, v);
        const hyst_real u = hyst_tracking_controller_step(&controller, state, y_ref[k], y[k]);
        CHECK_SAME_BITS(&u, &expected, 1);
    }
    CHECK_SAME_BITS(state, x, 1);
    CHECK_SAME_BITS(state + 1, z, 2);
}

static void test_without_states(void)
{
    const hyst_tracking_controller gain = {0, NULL, NULL, NULL, {R(3.0), R(-2.0)}, {0, NULL}};
    hyst_real none[1] = {R(7.0)};
    CHECK_EQUAL(hyst_tracking_controller_step(&gain, none, R(2.0), R(0.5)), R(5.0));
    CHECK_EQUAL(none[0], R(7.0));
}

static void test_guard_holds_output_and_state(void)
{
    const hyst_stage stage = {&hyst_pi_kind, &(const hyst_pi){2, R(1.0), p, r}};
    hyst_tracking_controller controller = pi_controller();
    controller.inverse.count = 1;
    controller.inverse.stage = &stage;
    const hyst_real bad[][2] = {{(hyst_real)NAN, R(0.0)},      {R(0.0), (hyst_real)NAN},
                                {(hyst_real)INFINITY, R(1.0)}, {R(1.0), -(hyst_real)INFINITY},
                                {REAL_MAX, -REAL_MAX}};
    hyst_real state[3] = {0}, before[3];
    hyst_guard guard = {R(0.0), 0};
    const hyst_real good = hyst_guarded_tracking_step(&controller, state, &guard, R(4.0), R(1.0));
    CHECK(guard.fault == 0);
    CHECK_EQUAL(good, R(6.0) + R(0.5) * R(5.0) + R(0.25) * R(4.0)); /* v = 6 */
    memcpy(before, state, sizeof before);
    for (size_t i = 0; i < COUNT(bad); ++i) {
        guard.fault = 0;
        CHECK_EQUAL(hyst_guarded_tracking_step(&controller, state, &guard, bad[i][0], bad[i][1]),
                    good);
        CHECK(guard.fault);
        CHECK_SAME_BITS(state, before, 3);
    }
    (void)hyst_guarded_tracking_step(&controller, state, &guard, R(1.0), R(1.0));
    CHECK(guard.fault); /* until the caller lowers it */
}

int main(void)
{
    test_by_hand();
    test_inverse_follows_the_linear_part();
    test_without_states();
    test_guard_holds_output_and_state();
    return check_result();
}
