/* Creep against numbers by hand, and its inverse. */
#include "hyst/creep.h"

#include "check.h"

static const hyst_real weight[] = {R(0.5), R(-0.25)};
static const hyst_real gain[] = {R(0.5), R(0.125)};

static hyst_creep two_lags(int inverse)
{
    hyst_creep model;
    model.count = 2;
    model.weight = weight;
    model.gain = gain;
    model.inverse = inverse;
    return model;
}

/* A step of 1: x is 0, 1/2, 3/4 and 0, 1/8, 15/64. */
static void follows_hand_calculation_and_back(void)
{
    const hyst_creep model = two_lags(0), inverse = two_lags(1);
    const hyst_real expected[] = {R(1.0), R(1.21875), R(1.31640625)};
    hyst_real there[4] = {R(0.0), R(0.0), R(0.0), R(0.0)}, home[4] = {R(0.0), R(0.0), R(0.0), R(0.0)};
    for (size_t k = 0; k < COUNT(expected); ++k) {
        const hyst_real y = hyst_creep_step(&model, there, R(1.0));
        CHECK_EQUAL(y, expected[k]);
        CHECK_EQUAL(hyst_creep_step(&inverse, home, y), R(1.0));
        CHECK_SAME_BITS(home, there, 4);
    }
}

/* 1 - exp(-1), and 1 - exp(-x) = x - x^2 / 2 + x^3 / 6 of a small x. */
static void gains_keep_their_digits(void)
{
    CHECK_NEAR((double)hyst_creep_gain(R(1.0)), 0.6321205588285577, 4.0 * (double)REAL_EPSILON);
    CHECK_NEAR((double)hyst_creep_gain(R(1e6)) * 1e6, 1.0 - 0.5e-6 + 1e-12 / 6.0, 8.0 * (double)REAL_EPSILON);
    CHECK_EQUAL(hyst_creep_gain(R(1e-6)), R(1.0));
}

/* A lag of 4e6 samples after as many: 1 - 1/e, though single steps are lost in single precision. */
static void slow_lags_arrive(void)
{
    const hyst_real one[] = {R(1.0)}, slow[] = {hyst_creep_gain(R(4e6))};
    const hyst_creep model = {1, one, slow, 0};
    hyst_real state[2] = {R(0.0), R(0.0)};
    for (size_t k = 0; k < 4000000u; ++k) {
        hyst_creep_step(&model, state, R(1.0));
    }
    CHECK_NEAR((double)state[0], 0.6321205588285577, 1e-9 + 4.0 * (double)REAL_EPSILON);
}

static void what_is_not_finite_is_answered_and_not_kept(void)
{
    const hyst_creep model = two_lags(0);
    hyst_real state[4] = {-REAL_MAX, R(0.0), R(1.0), R(0.0)};
    const hyst_real before[4] = {-REAL_MAX, R(0.0), R(1.0), R(0.0)};
    const hyst_real y = hyst_creep_step(&model, state, REAL_MAX);
    CHECK(!(y - y == R(0.0)));
    CHECK_SAME_BITS(state, before, 4);
}

static void row_asks_for_two_numbers_a_lag(void)
{
    const hyst_creep model = two_lags(0);
    hyst_real state[4] = {R(0.5), R(0.0), R(0.0), R(0.0)};
    CHECK(hyst_creep_kind.length(&model) == 4u);
    CHECK_EQUAL(hyst_creep_kind.step(&model, state, R(0.75)), R(1.0));
}

int main(void)
{
    follows_hand_calculation_and_back();
    gains_keep_their_digits();
    slow_lags_arrive();
    what_is_not_finite_is_answered_and_not_kept();
    row_asks_for_two_numbers_a_lag();
    return check_result();
}
