/* A delay by parts of a sample against numbers by hand, and its inverse. */
#include "hyst/delay.h"

#include "check.h"

static hyst_delay delay_of(size_t whole, hyst_real fraction, int inverse)
{
    hyst_delay model;
    model.whole = whole;
    model.fraction = fraction;
    model.lead = fraction / (R(1.0) - fraction);
    model.inverse = inverse;
    return model;
}

static const hyst_real u[] = {R(2.0), R(4.0), R(8.0), R(0.0), R(1.0), R(3.0), R(5.0)};

/* Two samples and a quarter: 3/4 u_{k-2} + 1/4 u_{k-3}, with 2 before the first. */
static void is_late_by_samples_and_a_fraction(void)
{
    const hyst_real expected[] = {R(2.0), R(2.0), R(2.0), R(3.5), R(7.0), R(2.0), R(0.75)};
    const hyst_delay model = delay_of(2, R(0.25), 0);
    hyst_real state[5] = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
    for (size_t k = 0; k < COUNT(u); ++k) {
        CHECK_EQUAL(hyst_delay_step(&model, state, u[k]), expected[k]);
    }
}

static void whole_samples_pass_as_they_are(void)
{
    for (size_t whole = 0; whole < 4u; ++whole) {
        const hyst_delay model = delay_of(whole, R(0.0), 0);
        hyst_real state[6] = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
        for (size_t k = 0; k < COUNT(u); ++k) {
            CHECK_EQUAL(hyst_delay_step(&model, state, u[k]), u[k < whole ? 0u : k - whole]);
        }
    }
}

static void less_than_half_a_sample_is_taken_back(void)
{
    const hyst_delay model = delay_of(0, R(0.25), 0), inverse = delay_of(0, R(0.25), 1);
    hyst_real there[3] = {R(0.0), R(0.0), R(0.0)}, home[3] = {R(0.0), R(0.0), R(0.0)};
    for (size_t k = 0; k < COUNT(u); ++k) {
        const hyst_real back = hyst_delay_step(&inverse, home, hyst_delay_step(&model, there, u[k]));
        CHECK_NEAR((double)back, (double)u[k], 8.0 * 8.0 * (double)REAL_EPSILON);
    }
}

/* Whatever numbers a state holds, nothing outside the ring is touched. */
static void counts_outside_the_ring_begin_anew(void)
{
    const hyst_delay model = delay_of(2, R(0.5), 0);
    hyst_real state[6] = {R(7e9), R(-3.0), R(1.0), R(1.0), R(1.0), R(42.0)};
    CHECK_EQUAL(hyst_delay_step(&model, state, R(5.0)), R(5.0));
    CHECK_EQUAL(state[0], R(1.0));
    CHECK_EQUAL(state[1], R(1.0));
    CHECK_EQUAL(state[2], R(5.0));
    CHECK_EQUAL(state[5], R(42.0));
}

static void what_is_not_finite_is_answered_and_not_kept(void)
{
    const hyst_delay model = delay_of(1, R(0.5), 0);
    const hyst_real before[4] = {R(0.0), R(2.0), -REAL_MAX, R(1.0)};
    hyst_real state[4] = {R(0.0), R(2.0), -REAL_MAX, R(1.0)};
    const hyst_real y = hyst_delay_step(&model, state, REAL_MAX * R(2.0));
    CHECK(!(y - y == R(0.0)));
    CHECK_SAME_BITS(state, before, 4);
}

static void row_asks_for_ring_and_counts(void)
{
    const hyst_delay model = delay_of(1, R(0.5), 0);
    hyst_real state[4] = {R(0.0), R(2.0), R(2.0), R(4.0)};
    CHECK(hyst_delay_kind.length(&model) == 4u);
    CHECK_EQUAL(hyst_delay_kind.step(&model, state, R(9.0)), R(3.0));
}

int main(void)
{
    is_late_by_samples_and_a_fraction();
    whole_samples_pass_as_they_are();
    less_than_half_a_sample_is_taken_back();
    counts_outside_the_ring_begin_anew();
    what_is_not_finite_is_answered_and_not_kept();
    row_asks_for_ring_and_counts();
    return check_result();
}
