#include "check.h"

static const hyst_real one[] = {R(1.0)};
static const hyst_real quarter[] = {R(0.25)};

static hyst_radius one_play(int least_squares)
{
    const hyst_radius radius = {1, R(0.0), one, quarter, least_squares, R(1.0), one, R(10.0),
                                R(0.0), R(0.0), R(0.0), R(1.0)};
    return radius;
}

/* y = play of radius 1, p = 1; the estimate starts from r = 3, gain 0.25.
 *   u  y   slope  regime    z of the estimate   e     phi   r
 *   0  0   (first sample)
 *   4  3   0.75   envelope  4 - 3 = 1           2     -1    3 - 0.5 = 2.5
 *   6  5   1      envelope  6 - 2.5 = 3.5       1.5   -1    2.125
 *   5  5   0      interior  6 - 2.125 = 3.875   1.125 -1    1.84375
 *   2  3   2/3    envelope  2 + 1.84375         -.84375 +1  1.6328125 */
static void gradient_follows_hand_calculation(void)
{
    const hyst_real u[] = {R(0.0), R(4.0), R(6.0), R(5.0), R(2.0)};
    const hyst_real y[] = {R(0.0), R(3.0), R(5.0), R(5.0), R(3.0)};
    const hyst_real r[] = {R(3.0), R(2.5), R(2.125), R(1.84375), R(1.6328125)};
    const hyst_radius radius = one_play(0);
    const hyst_radius_layout at = hyst_radius_places(&radius);
    hyst_real state[64] = {R(0.0)};
    const hyst_real z0[] = {R(0.0)};
    CHECK(at.length <= COUNT(state));
    state[at.r] = R(3.0);
    hyst_radius_start(&radius, state, z0);
    for (size_t k = 0; k < COUNT(u); ++k) {
        CHECK(hyst_radius_step(&radius, state, u[k], y[k]) == (k > 0));
        CHECK_EQUAL(state[at.r], r[k]);
    }
}

/* Variance 1 and noise 1 at the start: gain 1/2, then 1/3. Errors 2 and, from r = 2, 1. */
static void least_squares_follows_hand_calculation(void)
{
    const hyst_radius radius = one_play(1);
    const hyst_radius_layout at = hyst_radius_places(&radius);
    hyst_real state[64] = {R(0.0)};
    const hyst_real z0[] = {R(0.0)};
    state[at.r] = R(3.0);
    hyst_radius_start(&radius, state, z0);
    hyst_radius_step(&radius, state, R(0.0), R(0.0));
    hyst_radius_step(&radius, state, R(4.0), R(3.0));
    CHECK_EQUAL(state[at.r], R(2.0));
    hyst_radius_step(&radius, state, R(6.0), R(5.0));
    CHECK_NEAR((double)state[at.r], 5.0 / 3.0, 4.0 * (double)REAL_EPSILON);
}

/* At rest the regime is what it was, and the estimate goes on. */
static void goes_on_while_the_input_rests(void)
{
    const hyst_radius radius = one_play(0);
    const hyst_radius_layout at = hyst_radius_places(&radius);
    hyst_real state[64] = {R(0.0)};
    const hyst_real z0[] = {R(0.0)};
    state[at.r] = R(3.0);
    hyst_radius_start(&radius, state, z0);
    hyst_radius_step(&radius, state, R(0.0), R(0.0));
    hyst_radius_step(&radius, state, R(4.0), R(3.0));
    CHECK(hyst_radius_step(&radius, state, R(4.0), R(3.0)) == 1);
    CHECK_EQUAL(state[at.r], R(2.125)); /* z = 1.5, e = 1.5 */
}

static void bad_samples_change_nothing_but_their_count(void)
{
    const hyst_radius radius = one_play(0);
    const hyst_radius_layout at = hyst_radius_places(&radius);
    hyst_real state[64] = {R(0.0)};
    hyst_real before[64];
    const hyst_real z0[] = {R(0.0)};
    const hyst_real bad[] = {(hyst_real)NAN, (hyst_real)INFINITY, (hyst_real)-INFINITY};
    state[at.r] = R(3.0);
    hyst_radius_start(&radius, state, z0);
    hyst_radius_step(&radius, state, R(0.0), R(0.0));
    hyst_radius_step(&radius, state, R(4.0), R(3.0));
    memcpy(before, state, sizeof before);
    for (size_t i = 0; i < COUNT(bad); ++i) {
        CHECK(hyst_radius_step(&radius, state, bad[i], R(1.0)) == 0);
        CHECK(hyst_radius_step(&radius, state, R(1.0), bad[i]) == 0);
    }
    CHECK_EQUAL(state[HYST_RADIUS_SKIPPED], R(6.0));
    state[HYST_RADIUS_SKIPPED] = R(0.0);
    CHECK_SAME_BITS(state, before, at.length);
}

static void no_plays_are_no_trouble(void)
{
    const hyst_radius radius = {0, R(1.0), NULL, NULL, 0, R(1.0), NULL, R(10.0),
                                R(0.0), R(0.0), R(0.0), R(1.0)};
    hyst_real state[64] = {R(0.0)};
    hyst_radius_start(&radius, state, NULL);
    CHECK(hyst_radius_step(&radius, state, R(0.0), R(0.0)) == 0);
    CHECK(hyst_radius_step(&radius, state, R(1.0), R(1.0)) == 0);
    CHECK(hyst_radius_step(&radius, state, R(0.5), R(0.5)) == 0);
}

/* The plant of the first test with an output that noise has moved, so that the measured slope would be
 * wrong at every sample; the regimes of the plant are told.
 *   u  y    regime    z of the estimate  e      r
 *   0  0    (first sample)
 *   4  2    envelope  4 - 3 = 1          1      2.75    (measured slope 0.5: between two)
 *   6  6    envelope  6 - 2.75           2.75   2.0625  (2)
 *   5  6    interior  6 - 2.0625         2.0625 1.546875 (0)
 *   5  5    at rest, unknown: as it was, z = 6 - 1.546875, e = .546875, r = 1.41015625
 *   4  9    unknown: not used */
static void a_regime_from_outside_takes_the_place_of_the_slope(void)
{
    const hyst_real u[] = {R(0.0), R(4.0), R(6.0), R(5.0), R(5.0), R(4.0)};
    const hyst_real y[] = {R(0.0), R(2.0), R(6.0), R(6.0), R(5.0), R(9.0)};
    const hyst_real told[] = {R(0.0), R(1.0), R(1.0), R(0.0), (hyst_real)NAN, (hyst_real)NAN};
    const hyst_real r[] = {R(3.0), R(2.75), R(2.0625), R(1.546875), R(1.41015625), R(1.41015625)};
    for (int is_slope = 0; is_slope < 2; ++is_slope) {
        const hyst_radius radius = one_play(0);
        const hyst_radius_layout at = hyst_radius_places(&radius);
        hyst_real state[64] = {R(0.0)};
        const hyst_real z0[] = {R(0.0)};
        state[at.r] = R(3.0);
        hyst_radius_start(&radius, state, z0);
        for (size_t k = 0; k < COUNT(u); ++k) {
            /* The slope of the plant is as many units as plays are on their envelopes. */
            const int used = hyst_radius_step_told(&radius, state, u[k], y[k], is_slope, told[k]);
            CHECK(used == (k > 0 && k < 5));
            CHECK_EQUAL(state[at.r], r[k]);
        }
        /* More plays than there are, and fewer than none, are no regime. */
        CHECK(hyst_radius_step_told(&radius, state, R(2.0), R(3.0), 0, R(2.0)) == 0);
        CHECK(hyst_radius_step_told(&radius, state, R(1.0), R(2.0), 0, R(-1.0)) == 0);
    }
}

/* Up to 6 and back to 5 unmeasured, with a radius of 1: on the envelope, then inside with u_m = 6 and
 * z = 5. The first output only begins the slope; the next are 0 apart, so the play is inside. */
static void inputs_without_outputs_are_followed(void)
{
    const hyst_radius radius = one_play(0);
    const hyst_radius_layout at = hyst_radius_places(&radius);
    hyst_real state[64] = {R(0.0)};
    const hyst_real z0[] = {R(0.0)};
    state[at.r] = R(1.0);
    hyst_radius_start(&radius, state, z0);
    hyst_radius_follow(&radius, state, R(0.0));
    hyst_radius_follow(&radius, state, R(6.0));
    hyst_radius_follow(&radius, state, R(5.0));
    hyst_radius_follow(&radius, state, (hyst_real)NAN);
    CHECK_EQUAL(state[HYST_RADIUS_SKIPPED], R(1.0));
    CHECK_EQUAL(state[at.home], R(6.0));
    CHECK_EQUAL(state[at.side], R(-1.0));
    CHECK(hyst_radius_step(&radius, state, R(4.5), R(5.0)) == 0);
    CHECK(hyst_radius_step(&radius, state, R(4.25), R(5.0)) == 1);
    CHECK_EQUAL(state[HYST_RADIUS_ERROR], R(0.0));
    CHECK(hyst_radius_step(&radius, state, R(4.125), R(5.0)) == 1);
    CHECK_EQUAL(state[at.r], R(1.0));
}

int main(void)
{
    a_regime_from_outside_takes_the_place_of_the_slope();
    inputs_without_outputs_are_followed();
    no_plays_are_no_trouble();
    gradient_follows_hand_calculation();
    least_squares_follows_hand_calculation();
    goes_on_while_the_input_rests();
    bad_samples_change_nothing_but_their_count();
    return check_result();
}
