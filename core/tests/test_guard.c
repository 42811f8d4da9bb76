#include "check.h"

static const hyst_real one[] = {R(1.0)};
static const hyst_real half[] = {R(0.5)};

static void finite_is_told_from_the_rest(void)
{
    CHECK(hyst_is_finite(R(0.0)) == 1);
    CHECK(hyst_is_finite(-R(1.5)) == 1);
    CHECK(hyst_is_finite(REAL_MAX) == 1);
    CHECK(hyst_is_finite(-REAL_MAX) == 1);
    CHECK(hyst_is_finite((hyst_real)INFINITY) == 0);
    CHECK(hyst_is_finite((hyst_real)-INFINITY) == 0);
    CHECK(hyst_is_finite((hyst_real)NAN) == 0);
}

/* y = play(u), threshold 1, between good samples and each kind of bad one. */
static void bad_input_holds_output_and_state(void)
{
    const hyst_stage play = {&hyst_play_kind, &(const hyst_real){R(1.0)}};
    const hyst_chain chain = {1, &play};
    const hyst_real bad[] = {(hyst_real)NAN, (hyst_real)INFINITY, (hyst_real)-INFINITY};
    for (size_t i = 0; i < COUNT(bad); ++i) {
        hyst_guard guard = {R(-5.0), 0};
        hyst_real state[] = {R(0.25)};
        CHECK_EQUAL(hyst_guarded_step(&chain, state, &guard, bad[i]), R(-5.0)); /* the safe output */
        CHECK_EQUAL(state[0], R(0.25));
        CHECK(guard.fault == 1);
        CHECK_EQUAL(hyst_guarded_step(&chain, state, &guard, R(3.0)), R(2.0));
        CHECK_EQUAL(hyst_guarded_step(&chain, state, &guard, bad[i]), R(2.0)); /* the last output */
        CHECK_EQUAL(state[0], R(2.0));
    }
}

static void flag_stays_up_until_lowered(void)
{
    const hyst_stage play = {&hyst_play_kind, &(const hyst_real){R(1.0)}};
    const hyst_chain chain = {1, &play};
    hyst_guard guard = {R(0.0), 0};
    hyst_real state[] = {R(0.0)};
    hyst_guarded_step(&chain, state, &guard, R(1.0));
    CHECK(guard.fault == 0);
    hyst_guarded_step(&chain, state, &guard, (hyst_real)NAN);
    hyst_guarded_step(&chain, state, &guard, R(1.0));
    CHECK(guard.fault == 1);
    guard.fault = 0;
    hyst_guarded_step(&chain, state, &guard, R(1.0));
    CHECK(guard.fault == 0);
}

/* PI, then an affine stage that overflows, then a play: the PI has seen the sample, the play not. */
static void overflow_between_stages_goes_no_further(void)
{
    const hyst_stage stages[] = {
        {&hyst_pi_kind, &(const hyst_pi){1, R(0.0), one, half}},
        {&hyst_affine_kind, &(const hyst_affine){REAL_MAX, R(0.0)}},
        {&hyst_play_kind, &(const hyst_real){R(1.0)}},
    };
    const hyst_chain chain = {COUNT(stages), stages};
    hyst_guard guard = {R(0.0), 0};
    hyst_real state[] = {R(0.0), R(7.0)};
    CHECK_EQUAL(hyst_guarded_step(&chain, state, &guard, R(2.5)), R(0.0));
    CHECK(guard.fault == 1);
    CHECK_EQUAL(state[0], R(2.0));
    CHECK_EQUAL(state[1], R(7.0));
}

/* inf - inf inside one stage: REAL_MAX 2 - REAL_MAX 2 is NaN. The state stays finite. */
static void overflow_inside_a_stage_is_caught_at_its_output(void)
{
    const hyst_real weight[] = {REAL_MAX, -REAL_MAX};
    const hyst_real threshold[] = {R(0.0), R(0.0)};
    const hyst_stage stages[] = {
        {&hyst_dead_zone_kind, &(const hyst_dead_zone){2, weight, threshold}},
        {&hyst_pi_kind, &(const hyst_pi){1, R(1.0), one, half}},
    };
    const hyst_chain chain = {COUNT(stages), stages};
    hyst_guard guard = {R(4.0), 0};
    hyst_real state[] = {R(0.125)};
    CHECK_EQUAL(hyst_guarded_step(&chain, state, &guard, R(2.0)), R(4.0));
    CHECK(guard.fault == 1);
    CHECK_EQUAL(state[0], R(0.125));
}

/* Good, huge and impossible values, each after each: output and state stay finite. */
static void nothing_gets_in(void)
{
    const hyst_real weight[] = {REAL_MAX, -R(3.0)};
    const hyst_real threshold[] = {R(100.0), R(0.0)};
    const hyst_stage stages[] = {
        {&hyst_direction_dead_zone_kind, &(const hyst_dead_zone){2, weight, threshold}},
        {&hyst_pi_kind, &(const hyst_pi){1, R(2.0), one, half}},
        {&hyst_stop_kind, &(const hyst_real){REAL_MAX}},
        {&hyst_play_kind, &(const hyst_real){R(0.5)}},
    };
    const hyst_chain chain = {COUNT(stages), stages};
    const hyst_real fed[] = {R(1.0),   (hyst_real)NAN,       REAL_MAX, (hyst_real)INFINITY,
                             R(200.0), (hyst_real)-INFINITY, R(-3.0),  -REAL_MAX};
    hyst_guard guard = {R(0.0), 0};
    hyst_real state[4] = {R(0.0)};
    for (size_t k = 0; k < 2 * COUNT(fed) * COUNT(fed); ++k) {
        const size_t pair = k / 2;
        const hyst_real u = fed[k % 2 == 0 ? pair / COUNT(fed) : pair % COUNT(fed)];
        CHECK(hyst_is_finite(hyst_guarded_step(&chain, state, &guard, u)));
        for (size_t i = 0; i < COUNT(state); ++i) {
            CHECK(hyst_is_finite(state[i]));
        }
    }
    CHECK(guard.fault == 1);
}

static void good_samples_are_those_of_the_plain_chain(void)
{
    const hyst_stage stages[] = {
        {&hyst_affine_kind, &(const hyst_affine){R(1.1), R(0.3)}},
        {&hyst_pi_kind, &(const hyst_pi){1, R(0.7), one, half}},
        {&hyst_play_kind, &(const hyst_real){R(0.25)}},
    };
    const hyst_chain chain = {COUNT(stages), stages};
    hyst_real u[500];
    hyst_guard guard = {R(0.0), 0};
    hyst_real state[] = {R(0.0), R(0.0)}, state_guarded[] = {R(0.0), R(0.0)};
    fill_with_noise(u, COUNT(u), R(3.0));
    for (size_t k = 0; k < COUNT(u); ++k) {
        const hyst_real y = hyst_guarded_step(&chain, state_guarded, &guard, u[k]);
        const hyst_real expected = hyst_chain_step(&chain, state, u[k]);
        CHECK_SAME_BITS(&y, &expected, 1);
    }
    CHECK_SAME_BITS(state_guarded, state, 2);
    CHECK(guard.fault == 0);
}

int main(void)
{
    finite_is_told_from_the_rest();
    bad_input_holds_output_and_state();
    flag_stays_up_until_lowered();
    overflow_between_stages_goes_no_further();
    overflow_inside_a_stage_is_caught_at_its_output();
    nothing_gets_in();
    good_samples_are_those_of_the_plain_chain();
    return check_result();
}
