/* A bank whose drive is limited: numbers by hand, powers of two, so that nothing is rounded; and the
 * limited inverse that keeps the model beside it. */
#include "check.h"

/* v = 0.5 u + 0.5 play(u, 1): slopes 0.5 and 1. Its inverse is u = 2 v - play(v, 0.5). */
static const hyst_real half[] = {R(0.5)}, one[] = {R(1.0)}, minus_one[] = {R(-1.0)};
static const hyst_pi stage_pi = {1, R(0.5), half, one};
static const hyst_pi inverse_pi = {1, R(2.0), minus_one, half};

/* At 2 and -2 the play of the model is at 1 and -1: it moves on every way there. u <= v + 0.5. */
static const hyst_bank_limits two = {
    R(-2.0), R(2.0), {1, R(1.0), R(-0.5), R(-1.5), R(0.5)}, {1, R(1.0), R(0.5), R(1.5), R(0.5)}};

static void test_by_hand(void)
{
    hyst_real state[2] = {0};
    int held = 0;
    CHECK_EQUAL(hyst_limited_bank_step(&inverse_pi, &two, state, &held, R(1.0)), R(1.5));
    CHECK_EQUAL(state[0], R(0.5));
    CHECK_EQUAL(state[1], R(1.5));
    CHECK(held == 0);
    /* u would be 8 - 3.5 = 4.5: held at 2, where the stage makes 1 + 0.5 = 1.5. */
    CHECK_EQUAL(hyst_limited_bank_step(&inverse_pi, &two, state, &held, R(4.0)), R(2.0));
    CHECK_EQUAL(state[0], R(1.0)); /* of 1.5, not of 4 */
    CHECK_EQUAL(state[1], R(2.0));
    CHECK(held == 1);
    /* down by 0.5: the play rests, so u = 2 - 1 */
    CHECK_EQUAL(hyst_limited_bank_step(&inverse_pi, &two, state, &held, R(1.0)), R(1.0));
    CHECK_EQUAL(hyst_limited_bank_step(&inverse_pi, &two, state, &held, -REAL_MAX), R(-2.0));
    CHECK_EQUAL(state[0], R(-1.0));
    CHECK(held == 1); /* until the caller lowers it */
}

/* A play that was led to 3 rests at the end, which lies where no play moves. */
static void test_a_memory_from_beyond_the_limits(void)
{
    hyst_real state[2] = {R(2.75), R(2.0)};
    int held = 0;
    /* u = 2 v - 2.75 while the play rests, from v = 2.25 on: so 2 belongs to v = 2.375. */
    CHECK_EQUAL(hyst_limited_bank_step(&inverse_pi, &two, state, &held, R(9.0)), R(2.0));
    CHECK_EQUAL(state[0], R(2.75));
    CHECK_EQUAL(hyst_limited_bank_step(&inverse_pi, &two, state, &held, R(2.3125)), R(1.875));
    /* And led to 8, it must come down before the drive can be as low as 2. */
    state[0] = R(8.0);
    CHECK_EQUAL(hyst_limited_bank_step(&inverse_pi, &two, state, &held, R(9.0)), R(2.0));
    CHECK_EQUAL(state[0], R(3.0)); /* v = 2.5: 5 - 3 */
}

static hyst_limited_inverse with_model(const hyst_stage *inverse, const hyst_stage *stage)
{
    const hyst_limited_inverse made = {{1, inverse}, {1, stage}, {R(-2.0), R(2.0), R(0.0)}};
    return made;
}

/* To rounding the same as with the model beside it, for noise that leaves the limits now and then; and
 * within them the bits of the bank. */
static void test_as_with_the_model_beside_it(void)
{
    const hyst_stage inverse = {&hyst_pi_kind, &inverse_pi}, stage = {&hyst_pi_kind, &stage_pi};
    const hyst_limited_inverse limited = with_model(&inverse, &stage);
    hyst_real state[2] = {0}, same[1], beside[3] = {0}, before[1], wanted[400];
    hyst_limited_guard guard = {{R(0.0), 0}, 0};
    size_t samples = 0;
    fill_with_noise(wanted, COUNT(wanted), R(3.0));
    for (size_t k = 0; k < COUNT(wanted); ++k) {
        hyst_real v = wanted[k];
        int held = 0;
        same[0] = state[0];
        const hyst_real u = hyst_limited_bank_step(&inverse_pi, &two, state, &held, v);
        const hyst_real other = hyst_limited_inverse_step(&limited, beside, before, &guard, &v);
        /* A few roundings of numbers up to 8. */
        CHECK_NEAR(u, other, R(32.0) * REAL_EPSILON);
        CHECK_NEAR(state[0], beside[0], R(32.0) * REAL_EPSILON);
        CHECK(u >= R(-2.0) && u <= R(2.0));
        if (held == 0) {
            CHECK_EQUAL(hyst_pi_step(&inverse_pi, same, wanted[k]), u);
            CHECK_SAME_BITS(same, state, 1);
        }
        samples += held != 0;
    }
    CHECK(samples > 50 && samples < COUNT(wanted) - 50);
}

static void test_without_plays(void)
{
    const hyst_pi plain = {0, R(2.0), NULL, NULL};
    const hyst_bank_limits limits = {
        R(-1.0), R(4.0), {0, R(2.0), R(0.0), R(-0.25), R(0.0)}, {0, R(2.0), R(0.0), R(1.75), R(0.0)}};
    hyst_real state[1] = {0};
    int held = 0;
    CHECK_EQUAL(hyst_limited_bank_step(&plain, &limits, state, &held, R(2.0)), R(4.0));
    CHECK(held == 0);
    CHECK_EQUAL(hyst_limited_bank_step(&plain, &limits, state, &held, R(2.5)), R(4.0));
    CHECK(held == 1);
    CHECK_EQUAL(hyst_limited_bank_step(&plain, &limits, state, &held, R(-2.5)), R(-1.0));
    CHECK_EQUAL(state[0], R(-1.0));
}

/* Constants whose products overflow give no number; the drive stays where it is. */
static void test_where_no_drive_exists_the_last_one_is_kept(void)
{
    const hyst_real huge[] = {-REAL_MAX};
    const hyst_pi bank = {1, REAL_MAX, huge, half};
    const hyst_bank_limits limits = {R(-2.0),
                                     R(2.0),
                                     {0, REAL_MAX, R(0.0), -REAL_MAX, R(0.0)},
                                     {0, REAL_MAX, R(0.0), REAL_MAX, R(0.0)}};
    hyst_real state[2] = {R(0.0), R(1.25)};
    int held = 0;
    CHECK_EQUAL(hyst_limited_bank_step(&bank, &limits, state, &held, R(4.0)), R(1.25));
    CHECK_EQUAL(state[1], R(1.25));
    CHECK(held == 1);
}

int main(void)
{
    test_by_hand();
    test_a_memory_from_beyond_the_limits();
    test_as_with_the_model_beside_it();
    test_without_plays();
    test_where_no_drive_exists_the_last_one_is_kept();
    return check_result();
}
