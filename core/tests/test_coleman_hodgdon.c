/* The hysteresis of Coleman and Hodgdon against numbers by hand. */
#include "hyst/coleman_hodgdon.h"

#include "check.h"

#define CLOSE (20.0 * (double)REAL_EPSILON)

static const hyst_real one_a[] = {R(2.0)}, one_b[] = {R(1.5)};
static const hyst_real two_a[] = {R(2.0), R(0.5)}, two_b[] = {R(1.5), R(0.5)}, knot[] = {R(1.0)};

static hyst_coleman_hodgdon linear(int inverse)
{
    const hyst_coleman_hodgdon model = {R(1.0), 1, one_a, one_b, knot, inverse};
    return model;
}

static hyst_coleman_hodgdon saturating(int inverse)
{
    const hyst_coleman_hodgdon model = {R(1.0), 2, two_a, two_b, knot, inverse};
    return model;
}

/* Out to 1: 2 - (1 - 1/e) / 2. Back to 0: D from -(1 - 1/e)/2 towards +1/2 over a way of 1. */
static void closed_form_by_hand(void)
{
    const hyst_coleman_hodgdon model = linear(0), inverse = linear(1);
    hyst_real there[4] = {R(0.0), R(0.0), R(0.0), R(0.0)}, home[4] = {R(0.0), R(0.0), R(0.0), R(0.0)};
    const double share = 1.0 - 0.36787944117144233;
    const double back = -0.5 * share + (0.5 + 0.5 * share) * share;
    const hyst_real out = hyst_coleman_hodgdon_step(&model, there, R(1.0));
    CHECK_NEAR((double)out, 2.0 - 0.5 * share, CLOSE);
    CHECK_NEAR((double)hyst_coleman_hodgdon_step(&inverse, home, out), 1.0, CLOSE);
    const hyst_real in = hyst_coleman_hodgdon_step(&model, there, R(0.0));
    CHECK_NEAR((double)in, back, CLOSE);
    CHECK_NEAR((double)hyst_coleman_hodgdon_step(&inverse, home, in), 0.0, CLOSE);
}

/* Beyond the knot f = 2 + (u - 1) / 2, and D = -(1 - 1/e)/2 wears off: at 3 by exp(-2). From there to
 * -2 it passes both knots. */
static void pieces_by_hand(void)
{
    const hyst_coleman_hodgdon model = saturating(0), inverse = saturating(1);
    hyst_real there[4] = {R(0.0), R(0.0), R(0.0), R(0.0)}, home[4] = {R(0.0), R(0.0), R(0.0), R(0.0)};
    const double at_knot = -0.5 * (1.0 - exp(-1.0)), at_three = at_knot * exp(-2.0);
    const hyst_real out = hyst_coleman_hodgdon_step(&model, there, R(3.0));
    CHECK_NEAR((double)out, 3.0 + at_three, CLOSE);
    CHECK_NEAR((double)hyst_coleman_hodgdon_step(&inverse, home, out), 3.0, 4.0 * CLOSE);
    double d = at_three * exp(-2.0);        /* at 1 */
    d = 0.5 + (d - 0.5) * exp(-2.0);        /* at -1 */
    d = d * exp(-1.0);                      /* at -2 */
    const hyst_real back = hyst_coleman_hodgdon_step(&model, there, R(-2.0));
    CHECK_NEAR((double)back, -2.5 + d, CLOSE);
    CHECK_NEAR((double)hyst_coleman_hodgdon_step(&inverse, home, back), -2.0, 4.0 * CLOSE);
}

static void samples_in_between_change_nothing(void)
{
    const hyst_coleman_hodgdon model = saturating(0);
    hyst_real once[4] = {R(0.0), R(0.25), R(0.0), R(0.25)}, often[4] = {R(0.0), R(0.25), R(0.0), R(0.25)};
    const hyst_real whole = hyst_coleman_hodgdon_step(&model, once, R(2.7));
    for (size_t k = 1; k < 1000u; ++k) {
        hyst_coleman_hodgdon_step(&model, often, (hyst_real)k * R(0.0025));
    }
    CHECK_EQUAL(hyst_coleman_hodgdon_step(&model, often, R(2.7)), whole);
    CHECK_EQUAL(hyst_coleman_hodgdon_step(&model, often, R(2.7)), whole);
}

static void what_overflows_leaves_the_state(void)
{
    const hyst_coleman_hodgdon model = linear(0), inverse = linear(1);
    hyst_real state[4] = {R(0.5), R(0.25), R(0.5), R(0.25)};
    const hyst_real answer = hyst_coleman_hodgdon_step(&model, state, REAL_MAX);
    CHECK(!(answer - answer <= R(0.0)));
    CHECK_EQUAL(state[0], R(0.5));
    CHECK_EQUAL(state[1], R(0.25));
    const hyst_real far = hyst_coleman_hodgdon_step(&inverse, state, REAL_MAX);
    CHECK_NEAR((double)(far / REAL_MAX), 0.5, CLOSE);
}

int main(void)
{
    closed_form_by_hand();
    pieces_by_hand();
    samples_in_between_change_nothing();
    what_overflows_leaves_the_state();
    return check_result();
}
