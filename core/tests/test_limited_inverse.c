/* An inverse with a limited drive against numbers by hand, and against an actuator driven by hand. Most
 * constants are powers of two, so nothing is rounded. */
#include "check.h"

/* v = 0.5 u + 0.5 play(u, 1): slopes 0.5 and 1. Its inverse is u = 2 v - play(v, 0.5). */
static const hyst_real half[] = {R(0.5)}, one[] = {R(1.0)}, minus_one[] = {R(-1.0)};
static const hyst_pi stage_pi = {1, R(0.5), half, one};
static const hyst_pi inverse_pi = {1, R(2.0), minus_one, half};
static const hyst_stage stage_stages[] = {{&hyst_pi_kind, &stage_pi}};
static const hyst_stage inverse_stages[] = {{&hyst_pi_kind, &inverse_pi}};

static hyst_limited_inverse limited_to(hyst_real low, hyst_real high, hyst_real change)
{
    const hyst_limited_inverse made = {
        {1, inverse_stages}, {1, stage_stages}, {low, high, change}};
    return made;
}

static void test_by_hand(void)
{
    const hyst_limited_inverse limited = limited_to(R(-2.0), R(2.0), R(0.0));
    hyst_real state[3] = {0}, before[1] = {R(9.0)}, v;
    hyst_limited_guard guard = {{R(0.0), 0}, 0};
    CHECK(hyst_limited_inverse_state_length(&limited) == 3);
    v = R(1.0); /* the play of the inverse goes to 0.5, so u = 1.5, of which the stage makes 1 */
    CHECK_EQUAL(hyst_limited_inverse_step(&limited, state, before, &guard, &v), R(1.5));
    CHECK_EQUAL(v, R(1.0));
    CHECK_EQUAL(state[0], R(0.5));
    CHECK_EQUAL(state[1], R(0.5));
    CHECK(guard.limited == 0);
    v = R(4.0); /* u would be 8 - 3.5 = 4.5: held at 2, where the stage makes 1 + 0.5 = 1.5 */
    CHECK_EQUAL(hyst_limited_inverse_step(&limited, state, before, &guard, &v), R(2.0));
    CHECK_EQUAL(v, R(1.5));
    CHECK_EQUAL(state[0], R(1.0)); /* of 1.5, not of 4 */
    CHECK_EQUAL(state[1], R(1.0));
    CHECK_EQUAL(state[2], R(2.0));
    CHECK(guard.limited == 1);
    CHECK(guard.guard.fault == 0);
    v = R(1.0); /* down by 0.5: the play rests, so u = 2 - 1 */
    CHECK_EQUAL(hyst_limited_inverse_step(&limited, state, before, &guard, &v), R(1.0));
    CHECK_EQUAL(v, R(1.0));
    CHECK(guard.limited == 1); /* until the caller lowers it */
}

static void test_rate_by_hand(void)
{
    const hyst_limited_inverse limited = limited_to(R(-8.0), R(8.0), R(0.5));
    hyst_real state[3] = {0}, before[1], v;
    hyst_limited_guard guard = {{R(0.0), 0}, 0};
    const hyst_real expected_v[] = {R(0.25), R(0.5), R(1.0)}; /* the play of 1 moves from 1 on */
    for (size_t k = 0; k < COUNT(expected_v); ++k) {
        v = R(4.0);
        CHECK_EQUAL(hyst_limited_inverse_step(&limited, state, before, &guard, &v),
                    R(0.5) * (hyst_real)(k + 1));
        CHECK_EQUAL(v, expected_v[k]);
    }
}

/* The memory of forward is that of the actuator whose drive was applied, and that of the inverse is
 * what belongs to it: to rounding, for ten plays and noise that leaves the limits now and then. */
static void test_memory_is_the_actuators(void)
{
    const hyst_limited_inverse limited = limited_to(R(-2.5), R(2.0), R(1.5));
    hyst_real state[3] = {0}, actuator[1] = {0}, mirror[1] = {0}, before[1], wanted[400];
    hyst_limited_guard guard = {{R(0.0), 0}, 0};
    size_t held = 0;
    fill_with_noise(wanted, COUNT(wanted), R(3.0));
    for (size_t k = 0; k < COUNT(wanted); ++k) {
        hyst_real v = wanted[k];
        const hyst_real u = hyst_limited_inverse_step(&limited, state, before, &guard, &v);
        const hyst_real made = hyst_chain_step(&limited.forward, actuator, u);
        const hyst_real back = hyst_chain_step(&limited.inverse, mirror, v);
        CHECK(u >= R(-2.5) && u <= R(2.0));
        CHECK_SAME_BITS(state + 1, actuator, 1);
        CHECK_SAME_BITS(state, mirror, 1);
        /* A few roundings of numbers up to 8. */
        CHECK_NEAR(made, v, R(32.0) * REAL_EPSILON);
        CHECK_NEAR(back, u, R(32.0) * REAL_EPSILON);
        held += v < wanted[k] || v > wanted[k];
    }
    CHECK(held > 50 && held < COUNT(wanted) - 50);
}

static void test_without_stages(void)
{
    const hyst_limited_inverse plain = {{0, NULL}, {0, NULL}, {R(-1.0), R(1.0), R(0.0)}};
    hyst_real state[1] = {0}, none[1], v = R(3.0);
    hyst_limited_guard guard = {{R(0.0), 0}, 0};
    CHECK_EQUAL(hyst_limited_inverse_step(&plain, state, none, &guard, &v), R(1.0));
    CHECK_EQUAL(v, R(1.0));
}

static void test_what_is_not_finite_changes_nothing(void)
{
    const hyst_limited_inverse limited = limited_to(R(-2.0), R(2.0), R(0.0));
    const hyst_real bad[] = {(hyst_real)NAN, (hyst_real)INFINITY, (hyst_real)-INFINITY};
    for (size_t i = 0; i < COUNT(bad); ++i) {
        hyst_real state[] = {R(0.25), R(0.5), R(1.0)}, before[1], v = bad[i];
        hyst_limited_guard guard = {{R(1.0), 0}, 0};
        CHECK_EQUAL(hyst_limited_inverse_step(&limited, state, before, &guard, &v), R(1.0));
        CHECK(guard.guard.fault == 1);
        CHECK(guard.limited == 0);
        CHECK_EQUAL(state[0], R(0.25));
        CHECK_EQUAL(state[1], R(0.5));
        CHECK_EQUAL(state[2], R(1.0));
    }
}

/* The inverse overflows on its way: the drive stays where it is, and v is what belongs to it. */
static void test_where_no_drive_exists_the_last_one_is_kept(void)
{
    const hyst_limited_inverse limited = limited_to(R(-2.0), R(2.0), R(0.0));
    hyst_real state[3] = {0}, before[1], v = R(1.0);
    hyst_limited_guard guard = {{R(0.0), 0}, 0};
    (void)hyst_limited_inverse_step(&limited, state, before, &guard, &v);
    v = REAL_MAX;
    CHECK_EQUAL(hyst_limited_inverse_step(&limited, state, before, &guard, &v), R(1.5));
    CHECK_EQUAL(v, R(1.0));
    CHECK_EQUAL(state[0], R(0.5));
    CHECK(guard.guard.fault == 1);
    CHECK(guard.limited == 1);
}

/* forward overflows: the inverse goes on with the v that was wanted, all stays finite. */
static void test_where_no_v_exists_all_stays_finite(void)
{
    const hyst_affine shrink = {R(0.25), R(0.0)}, grow = {REAL_MAX, R(0.0)};
    const hyst_stage down = {&hyst_affine_kind, &shrink}, up = {&hyst_affine_kind, &grow};
    const hyst_limited_inverse limited = {{1, &down}, {1, &up}, {R(-4.0), R(4.0), R(0.0)}};
    hyst_real state[1] = {0}, none[1], v = R(32.0);
    hyst_limited_guard guard = {{R(0.0), 0}, 0};
    CHECK_EQUAL(hyst_limited_inverse_step(&limited, state, none, &guard, &v), R(4.0));
    CHECK_EQUAL(v, R(32.0));
    CHECK(guard.guard.fault == 1);
}

int main(void)
{
    test_by_hand();
    test_rate_by_hand();
    test_memory_is_the_actuators();
    test_without_stages();
    test_what_is_not_finite_changes_nothing();
    test_where_no_drive_exists_the_last_one_is_kept();
    test_where_no_v_exists_all_stays_finite();
    return check_result();
}
