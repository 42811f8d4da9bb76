/* The tracking controller with limits against the difference equation worked out by hand. Most constants
 * are powers of two, so nothing is rounded. */
#include "check.h"

/* v = 2 e + 0.5 x, x' = x + e; conditioned: w = 1/2, the e that would have given v_a goes into x. */
static const hyst_real integrator[] = {R(1.0)}, slow[] = {R(0.5)}, conditioned[] = {R(0.5)};
static const hyst_real difference[] = {R(1.0), R(-1.0)}; /* e = y_ref - y */
static const hyst_real p[] = {R(0.5)}, r[] = {R(1.0)}, g[] = {R(-1.0)}, s[] = {R(0.5)};
static const hyst_pi stage_pi = {1, R(0.5), p, r}, inverse_pi = {1, R(2.0), g, s};
static const hyst_stage stage_stages[] = {{&hyst_pi_kind, &stage_pi}};
static const hyst_stage inverse_stages[] = {{&hyst_pi_kind, &inverse_pi}};

static hyst_limited_tracking controller_of(size_t stages, hyst_real limit)
{
    const hyst_limited_tracking made = {
        {1, integrator, difference, slow, {R(2.0), R(-2.0)}, {0, NULL}},
        conditioned,
        {{stages, inverse_stages}, {stages, stage_stages}, {-limit, limit, R(0.0)}}};
    return made;
}

static void test_by_hand(void)
{
    const hyst_limited_tracking controller = controller_of(0, R(4.0));
    const hyst_real y_ref[] = {R(1.0), R(4.0), R(4.0), R(0.0)};
    /* x: 0, 1; then v = 8.5, held at 4: e counts as 4 - 4.5/2 = 1.75, so x = 2.75; then v = 9.375,
     * held: x = 2.75 + 4 - 5.375/2 = 4.0625; then v = 2.03125. */
    const hyst_real expected[] = {R(2.0), R(4.0), R(4.0), R(2.03125)};
    const hyst_real expected_excess[] = {R(0.0), R(-4.5), R(-5.375), R(0.0)};
    hyst_real state[2] = {0}, none[1], v = R(7.0), excess = R(7.0);
    hyst_limited_guard guard = {{R(0.0), 0}, 0};
    CHECK(hyst_limited_tracking_state_length(&controller) == 2);
    for (size_t k = 0; k < COUNT(y_ref); ++k) {
        CHECK_EQUAL(hyst_limited_tracking_step(&controller, state, none, &guard, y_ref[k], R(0.0),
                                               &v, &excess),
                    expected[k]);
        CHECK_EQUAL(v, expected[k]);
        CHECK_EQUAL(excess, expected_excess[k]);
        CHECK(guard.limited == (k > 0));
    }
    CHECK_EQUAL(state[0], R(4.0625));
    CHECK_EQUAL(state[1], R(2.03125));
}

/* Within the limits all bits are those of the controller without. */
static void test_within_limits_nothing_changes(void)
{
    const hyst_limited_tracking controller = controller_of(1, R(1000.0));
    hyst_tracking_controller plain = controller.linear;
    plain.inverse = controller.inverse.inverse;
    hyst_real state[4] = {0}, other[2] = {0}, before[1], y_ref[200], y[200], v, excess;
    hyst_limited_guard guard = {{R(0.0), 0}, 0};
    fill_with_noise(y_ref, COUNT(y_ref), R(3.0));
    fill_with_noise(y, COUNT(y), R(2.0));
    for (size_t k = 0; k < COUNT(y); ++k) {
        const hyst_real u = hyst_limited_tracking_step(&controller, state, before, &guard, y_ref[k],
                                                       y[k], &v, &excess);
        const hyst_real expected = hyst_tracking_controller_step(&plain, other, y_ref[k], y[k]);
        CHECK_SAME_BITS(&u, &expected, 1);
        CHECK_SAME_BITS(state, other, 2);
    }
    CHECK(guard.limited == 0);
}

/* An error that does not end moves x no farther than the drive can follow: 0.5 x = v_a at rest. */
static void test_does_not_wind_up(void)
{
    const hyst_limited_tracking controller = controller_of(1, R(4.0));
    hyst_real state[4] = {0}, before[1], v = R(0.0), excess;
    hyst_limited_guard guard = {{R(0.0), 0}, 0};
    for (size_t k = 0; k < 5000; ++k) {
        (void)hyst_limited_tracking_step(&controller, state, before, &guard, R(1000.0), R(0.0), &v,
                                         &excess);
    }
    CHECK_EQUAL(v, R(3.5)); /* of the drive 4: 2 + 0.5 * 3 */
    CHECK_NEAR(R(0.5) * state[0], v, R(1000.0) * REAL_EPSILON);
}

static void test_guard_holds_output_and_state(void)
{
    const hyst_limited_tracking controller = controller_of(1, R(4.0));
    const hyst_real bad[][2] = {{(hyst_real)NAN, R(0.0)},      {R(0.0), (hyst_real)NAN},
                                {(hyst_real)INFINITY, R(1.0)}, {R(1.0), -(hyst_real)INFINITY},
                                {REAL_MAX, -REAL_MAX}};
    hyst_real state[4] = {0}, was[4], before[1], v = R(0.0), excess = R(0.0);
    hyst_limited_guard guard = {{R(0.0), 0}, 0};
    const hyst_real good = hyst_limited_tracking_step(&controller, state, before, &guard, R(1.0),
                                                      R(0.0), &v, &excess);
    memcpy(was, state, sizeof was);
    for (size_t i = 0; i < COUNT(bad); ++i) {
        guard.guard.fault = 0;
        CHECK_EQUAL(hyst_limited_tracking_step(&controller, state, before, &guard, bad[i][0],
                                               bad[i][1], &v, &excess),
                    good);
        CHECK(guard.guard.fault == 1);
        CHECK(guard.limited == 0);
        CHECK_SAME_BITS(state, was, 4);
        CHECK_EQUAL(v, R(2.0)); /* of the good sample */
    }
}

int main(void)
{
    test_by_hand();
    test_within_limits_nothing_changes();
    test_does_not_wind_up();
    test_guard_holds_output_and_state();
    return check_result();
}
