/* A delay by 2/3 of a sample taken back by preview, against numbers by hand. */
#include "hyst/delay_preview.h"

#include "check.h"

/* q = 1/2 (f = 2/3), two samples ahead: u = y0 + q (y0 - (y1 + q (y1 - y2))). */
static void goes_back_from_the_newest_sample(void)
{
    const hyst_delay_preview model = {2, R(0.5)};
    const hyst_real y[] = {R(4.0), R(8.0), R(0.0), R(2.0), R(16.0)};
    /* 4 + (4 - (4 + (4 - 8)/2))/2 = 5;  4 + (4 - (8 + (8 - 0)/2))/2 = 0;
     * 8 + (8 - (0 + (0 - 2)/2))/2 = 12.5;  0 + (0 - (2 + (2 - 16)/2))/2 = 2.5 */
    const hyst_real expected[] = {R(4.0), R(5.0), R(0.0), R(12.5), R(2.5)};
    hyst_real state[5] = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
    for (size_t k = 0; k < COUNT(y); ++k) {
        CHECK_EQUAL(hyst_delay_preview_step(&model, state, y[k]), expected[k]);
    }
}

static void without_a_sample_ahead_passes_what_it_knows(void)
{
    const hyst_delay_preview model = {0, R(0.5)};
    hyst_real state[3] = {R(0.0), R(0.0), R(0.0)};
    CHECK_EQUAL(hyst_delay_preview_step(&model, state, R(3.0)), R(3.0));
    CHECK_EQUAL(hyst_delay_preview_step(&model, state, R(-1.0)), R(-1.0));
}

/* Whatever numbers a state holds, nothing outside the ring is touched. */
static void numbers_outside_the_ring_begin_anew(void)
{
    const hyst_delay_preview model = {1, R(0.5)};
    hyst_real state[5] = {R(-7.0), R(1e9), R(1.0), R(1.0), R(42.0)};
    CHECK_EQUAL(hyst_delay_preview_step(&model, state, R(5.0)), R(5.0));
    CHECK_EQUAL(state[0], R(1.0));
    CHECK_EQUAL(state[1], R(1.0));
    CHECK_EQUAL(state[2], R(5.0));
    CHECK_EQUAL(state[4], R(42.0));
}

static void what_is_not_finite_is_not_kept(void)
{
    const hyst_delay_preview model = {1, R(0.5)};
    const hyst_real before[4] = {R(1.0), R(1.0), R(1.0), R(0.0)};
    hyst_real state[4] = {R(1.0), R(1.0), R(1.0), R(0.0)};
    const hyst_real u = hyst_delay_preview_step(&model, state, REAL_MAX * R(2.0));
    CHECK(!(u - u == R(0.0)));
    CHECK_SAME_BITS(state, before, 4);
}

static void row_asks_for_ring_and_counts(void)
{
    const hyst_delay_preview model = {1, R(0.5)};
    hyst_real state[4] = {R(1.0), R(1.0), R(4.0), R(0.0)};
    CHECK(hyst_delay_preview_kind.length(&model) == 4u);
    CHECK_EQUAL(hyst_delay_preview_kind.step(&model, state, R(8.0)), R(2.0));
}

int main(void)
{
    goes_back_from_the_newest_sample();
    without_a_sample_ahead_passes_what_it_knows();
    numbers_outside_the_ring_begin_anew();
    what_is_not_finite_is_not_kept();
    row_asks_for_ring_and_counts();
    return check_result();
}
