#include "check.h"

static hyst_scale one_scale(hyst_real forgetting)
{
    const hyst_scale scale = {forgetting, R(20.0), R(1.0), R(0.25), R(4.0), 0, 0};
    return scale;
}

/* w = 0 2 0 2 .., y = 1 + 2 w + e with e = 1 1 -1 -1 .., which is orthogonal to 1 and w. After 16
 * samples: mean(w) = 1, mean(y) = 3, cww = 16, slope = 2; the squares of the 14 recursive residuals
 * sum to those of the residuals, 16, so noise = 16 / 14 and var(slope) = 16 / 14 / 16 = 1 / 14. The
 * start 1 has variance 1: share = 1 / (1 + 1 / 14) = 14 / 15, scale = 1 + 14 / 15. */
static void least_squares_follows_hand_calculation(void)
{
    const hyst_scale scale = one_scale(R(0.0));
    const hyst_real e[] = {R(1.0), R(1.0), R(-1.0), R(-1.0)};
    hyst_real state[HYST_SCALE_LENGTH] = {R(0.0)};
    hyst_scale_start(&scale, state, R(1.0), R(0.5));
    CHECK_EQUAL(state[HYST_SCALE_OFFSET], R(0.5));
    CHECK_EQUAL(state[HYST_SCALE_VARIANCE], R(1.0));
    for (size_t k = 0; k < 16; ++k) {
        const hyst_real w = k % 2u > 0u ? R(2.0) : R(0.0);
        CHECK(hyst_scale_step(&scale, state, w, R(1.0) + R(2.0) * w + e[k % 4u]) ==
              HYST_SCALE_UPDATED);
        /* Fewer than 10 samples leave the start. */
        CHECK(k >= 9u || !(state[HYST_SCALE_SCALE] > R(1.0)));
    }
    /* Sixteen means of sixteen roundings. */
    const double few = 256.0 * (double)REAL_EPSILON;
    CHECK_NEAR((double)state[HYST_SCALE_MEAN_W], 1.0, few);
    CHECK_NEAR((double)state[HYST_SCALE_WW], 16.0, 16.0 * few);
    CHECK_NEAR((double)state[HYST_SCALE_NOISE], 16.0 / 14.0, few);
    CHECK_NEAR((double)state[HYST_SCALE_SLOPE_VARIANCE], 1.0 / 14.0, few);
    CHECK_NEAR((double)state[HYST_SCALE_SCALE], 29.0 / 15.0, few);
    CHECK_NEAR((double)state[HYST_SCALE_OFFSET], 3.0 - 29.0 / 15.0, few);
    CHECK_NEAR((double)state[HYST_SCALE_VARIANCE], 1.0 / 15.0, few);
    CHECK_NEAR((double)state[HYST_SCALE_MEAN_VARIANCE], 1.0 / 14.0, few);
    CHECK_EQUAL(state[HYST_SCALE_USED], R(16.0));
}

/* Errors of one sign for 8 samples each: sums of 8 have 8 times the mean square of noise. */
static void errors_that_follow_each_other_widen(void)
{
    hyst_scale scale = one_scale(R(0.0));
    hyst_real state[HYST_SCALE_LENGTH] = {R(0.0)};
    scale.scale_held = 1;
    scale.offset_held = 1;
    hyst_scale_start(&scale, state, R(1.0), R(0.0));
    for (size_t k = 0; k < 512; ++k) {
        hyst_scale_step(&scale, state, R(1.0), k / 8u % 2u > 0u ? R(2.0) : R(0.0));
    }
    CHECK_EQUAL(state[HYST_SCALE_NOISE], R(1.0));
    CHECK_EQUAL(state[HYST_SCALE_WIDE_MEAN], R(8.0));
    CHECK_EQUAL(state[HYST_SCALE_WIDE_SAMPLES], R(8.0));
}

/* A slope of 10 stops at 4 times the start, one of -1 at a quarter; the sign is that of the start. */
static void it_stays_within_bounds(void)
{
    const hyst_scale scale = one_scale(R(0.0));
    const hyst_real slopes[] = {R(10.0), R(-1.0)};
    const hyst_real ends[] = {R(4.0), R(0.25)};
    for (size_t i = 0; i < 2; ++i) {
        for (size_t j = 0; j < 2; ++j) {
            const hyst_real sign = j > 0u ? R(-1.0) : R(1.0);
            hyst_real state[HYST_SCALE_LENGTH] = {R(0.0)};
            hyst_scale_start(&scale, state, sign, R(0.0));
            for (size_t k = 0; k < 100; ++k) {
                const hyst_real w = (hyst_real)(k % 7u);
                hyst_scale_step(&scale, state, w, sign * slopes[i] * w);
            }
            CHECK_EQUAL(state[HYST_SCALE_SCALE], sign * ends[i]);
        }
    }
}

/* While w rests the sums of the slope stay; the means forget. */
static void at_rest_the_slope_is_kept(void)
{
    const hyst_scale scale = one_scale(R(0.125));
    hyst_real state[HYST_SCALE_LENGTH] = {R(0.0)};
    hyst_scale_start(&scale, state, R(1.0), R(0.0));
    for (size_t k = 0; k < 200; ++k) {
        const hyst_real w = (hyst_real)(k % 7u);
        hyst_scale_step(&scale, state, w, R(1.5) * w);
    }
    for (size_t k = 0; k < 400; ++k) {
        hyst_scale_step(&scale, state, R(3.0), R(4.75));
    }
    const hyst_real kept = state[HYST_SCALE_WW];
    CHECK(kept > R(0.1));
    for (size_t k = 0; k < 400; ++k) {
        hyst_scale_step(&scale, state, R(3.0), R(4.75));
    }
    CHECK_NEAR((double)state[HYST_SCALE_WW], (double)kept, 1e-3);
    /* 1.5 w + 0.25 there: what the slope is off, times what w is from its mean, 0, is no matter. */
    CHECK_NEAR((double)(state[HYST_SCALE_SCALE] * R(3.0) + state[HYST_SCALE_OFFSET]), 4.75,
               64.0 * (double)REAL_EPSILON);
}

static void what_is_not_finite_changes_nothing(void)
{
    const hyst_scale scale = one_scale(R(0.0));
    hyst_real state[HYST_SCALE_LENGTH] = {R(0.0)};
    hyst_real before[HYST_SCALE_LENGTH];
    hyst_scale_start(&scale, state, R(1.0), R(0.0));
    for (size_t k = 0; k < 20; ++k) {
        hyst_scale_step(&scale, state, (hyst_real)(k % 7u), (hyst_real)(k % 5u));
    }
    memcpy(before, state, sizeof before);
    CHECK(hyst_scale_step(&scale, state, R(1.0), (hyst_real)NAN) == HYST_SCALE_WAS_SKIPPED);
    CHECK(hyst_scale_step(&scale, state, -(hyst_real)INFINITY, R(1.0)) == HYST_SCALE_WAS_SKIPPED);
    CHECK(hyst_scale_step(&scale, state, R(1.0), REAL_MAX) == HYST_SCALE_WAS_REFUSED);
    CHECK_EQUAL(state[HYST_SCALE_SKIPPED], R(2.0));
    CHECK_EQUAL(state[HYST_SCALE_REFUSED], R(1.0));
    before[HYST_SCALE_SKIPPED] = R(2.0);
    before[HYST_SCALE_REFUSED] = R(1.0);
    CHECK_SAME_BITS(state, before, COUNT(state));
    /* Started anew it has counted what it has counted. */
    hyst_scale_start(&scale, state, R(2.0), R(1.0));
    CHECK_EQUAL(state[HYST_SCALE_USED], R(20.0));
    CHECK_EQUAL(state[HYST_SCALE_WEIGHT], R(0.0));
}

int main(void)
{
    least_squares_follows_hand_calculation();
    errors_that_follow_each_other_widen();
    it_stays_within_bounds();
    at_rest_the_slope_is_kept();
    what_is_not_finite_changes_nothing();
    return check_result();
}
