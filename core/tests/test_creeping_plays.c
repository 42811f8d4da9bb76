/* Plays whose outputs creep, against numbers by hand, and back. */
#include "hyst/creeping_plays.h"

#include "check.h"

static const hyst_real p[] = {R(0.5), R(0.25)}, r[] = {R(1.0), R(2.0)};
/* Of p0 = 1: 1, -1/3 and -0.25 / (1.5 1.75); thresholds 1 and 2.5. */
static const hyst_real p_back[] = {R(-0.33333333333333333), R(-0.095238095238095238)}, r_back[] = {R(1.0), R(2.5)};
static const hyst_real weight[] = {R(0.5), R(0.25), R(0.0), R(-0.5)}, gain[] = {R(0.5), R(0.25)};

static hyst_creeping_plays two_plays(int inverse)
{
    const hyst_pi plays = {2, R(1.0), p, r}, back = {inverse != 0 ? 2u : 0u, R(1.0), p_back, r_back};
    hyst_creeping_plays model;
    model.plays = plays;
    model.back = back;
    model.lags = 2;
    model.weight = weight;
    model.gain = gain;
    model.inverse = inverse;
    return model;
}

/* u = 5: z = 4, 3, y = 5 + 2 + 0.75. Then x = 2, 1 and 1.5, 0.75: u = 5 again adds 1 + 0.25 - 0.375;
 * x = 3, 1.75 and 2.25, 1.3125; u = 1 turns the plays to 2 and 3. */
static void follows_hand_calculation_and_back(void)
{
    const hyst_creeping_plays model = two_plays(0), inverse = two_plays(1);
    const hyst_real u[] = {R(5.0), R(5.0), R(1.0)};
    const hyst_real expected[] = {R(7.75), R(8.625), R(1.0 + 1.0 + 0.75 + 1.5 + 0.4375 - 0.65625)};
    hyst_real there[10], home[12];
    for (size_t i = 0; i < COUNT(home); ++i) {
        home[i] = R(0.0);
        there[i < COUNT(there) ? i : 0u] = R(0.0);
    }
    for (size_t k = 0; k < COUNT(u); ++k) {
        const hyst_real y = hyst_creeping_plays_step(&model, there, u[k]);
        CHECK_EQUAL(y, expected[k]);
        CHECK_NEAR((double)hyst_creeping_plays_step(&inverse, home, y), (double)u[k],
                   32.0 * (double)REAL_EPSILON);
    }
}

static void what_is_not_finite_is_answered_and_not_kept(void)
{
    const hyst_creeping_plays model = two_plays(0);
    const hyst_real before[10] = {R(1.0), R(1.0), REAL_MAX, R(0.0), REAL_MAX, R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
    hyst_real state[10];
    for (size_t i = 0; i < COUNT(before); ++i) {
        state[i] = before[i];
    }
    const hyst_real y = hyst_creeping_plays_step(&model, state, REAL_MAX);
    CHECK(!(y - y == R(0.0)));
    CHECK_SAME_BITS(state, before, 10);
}

static void row_asks_for_plays_and_two_numbers_a_lag(void)
{
    const hyst_creeping_plays model = two_plays(0), inverse = two_plays(1);
    hyst_real state[10] = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
    CHECK(hyst_creeping_plays_kind.length(&model) == 10u);
    CHECK(hyst_creeping_plays_kind.length(&inverse) == 12u);
    CHECK_EQUAL(hyst_creeping_plays_kind.step(&model, state, R(5.0)), R(7.75));
}

int main(void)
{
    follows_hand_calculation_and_back();
    what_is_not_finite_is_answered_and_not_kept();
    row_asks_for_plays_and_two_numbers_a_lag();
    return check_result();
}
