/* A first-order lag against numbers by hand, and its inverse. */
#include "hyst/lag.h"

#include "check.h"

static hyst_lag lag_of(hyst_real gain, hyst_real through, int inverse)
{
    hyst_lag model;
    model.gain = gain;
    model.through = through;
    model.per_through = R(1.0) / through;
    model.inverse = inverse;
    return model;
}

/* From rest at 2 to 3, 3, 5: 2, then 2 + 1/8, then 2.125 + (3 - 2.125)/4, then as it says. */
static void follows_hand_calculation_and_back(void)
{
    const hyst_lag model = lag_of(R(0.25), R(0.125), 0), inverse = lag_of(R(0.25), R(0.125), 1);
    const hyst_real u[] = {R(2.0), R(3.0), R(3.0), R(5.0)};
    const hyst_real expected[] = {R(2.0), R(2.125), R(2.34375), R(2.7578125)};
    hyst_real there[4] = {R(0.0), R(0.0), R(0.0), R(0.0)}, home[4] = {R(0.0), R(0.0), R(0.0), R(0.0)};
    for (size_t k = 0; k < COUNT(u); ++k) {
        const hyst_real y = hyst_lag_step(&model, there, u[k]);
        CHECK_EQUAL(y, expected[k]);
        CHECK_EQUAL(hyst_lag_step(&inverse, home, y), u[k]);
        CHECK_SAME_BITS(home, there, 4);
    }
}

/* b of x = dt / tau is x / 2 - x^2 / 6 + x^3 / 24 of a small x, 1/e at x = 1, and 1 - 1/x of a large one. */
static void feedthrough_keeps_its_digits(void)
{
    const double epsilon = (double)REAL_EPSILON;
    CHECK_NEAR((double)hyst_lag_through(R(1e6)) * 1e6, 0.5 - 1e-6 / 6.0 + 1e-12 / 24.0, 4.0 * epsilon);
    CHECK_NEAR((double)hyst_lag_through(R(1.0)), 0.36787944117144233, 4.0 * epsilon);
    CHECK_NEAR((double)hyst_lag_through(R(1.0001)), 0.3678530188989512, 8.0 * epsilon);
    CHECK_NEAR((double)hyst_lag_through(R(1e-3)), 0.999, 4.0 * epsilon);
    CHECK_NEAR((double)hyst_lag_through(R(1e-6)), 1.0 - 1e-6, 4.0 * epsilon);
}

/* A lag of 4e6 samples after as many: 1 - 1/e, though single steps are lost in single precision. */
static void slow_lags_arrive(void)
{
    const hyst_real gain = hyst_creep_gain(R(4e6));
    const hyst_lag model = lag_of(gain, gain, 0);
    hyst_real state[4] = {R(0.0), R(0.0), R(0.0), R(1.0)};
    for (size_t k = 0; k < 4000000u; ++k) {
        hyst_lag_step(&model, state, R(1.0));
    }
    CHECK_NEAR((double)state[0], 0.6321205588285577, 1e-9 + 4.0 * (double)REAL_EPSILON);
}

static void what_is_not_finite_is_answered_and_not_kept(void)
{
    const hyst_lag model = lag_of(R(0.5), R(0.25), 0);
    const hyst_real huge = REAL_MAX, infinite = huge * R(2.0);
    const hyst_real before[4] = {-huge, R(0.0), -huge, R(1.0)};
    hyst_real state[4] = {-huge, R(0.0), -huge, R(1.0)}, fresh[4] = {R(0.0), R(0.0), R(0.0), R(0.0)};
    const hyst_real nothing[4] = {R(0.0), R(0.0), R(0.0), R(0.0)};
    const hyst_real y = hyst_lag_step(&model, state, huge);
    CHECK(!(y - y == R(0.0)));
    CHECK_SAME_BITS(state, before, 4);
    const hyst_real first = hyst_lag_step(&model, fresh, infinite);
    CHECK(!(first - first == R(0.0)));
    CHECK_SAME_BITS(fresh, nothing, 4);
}

static void row_asks_for_four_numbers(void)
{
    const hyst_lag model = lag_of(R(0.5), R(0.25), 0);
    hyst_real state[4] = {R(1.0), R(0.0), R(1.0), R(1.0)};
    CHECK(hyst_lag_kind.length(&model) == 4u);
    CHECK_EQUAL(hyst_lag_kind.step(&model, state, R(2.0)), R(1.25));
}

int main(void)
{
    follows_hand_calculation_and_back();
    feedthrough_keeps_its_digits();
    slow_lags_arrive();
    what_is_not_finite_is_answered_and_not_kept();
    row_asks_for_four_numbers();
    return check_result();
}
