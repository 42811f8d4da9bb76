/* Generalized Maxwell-slip friction against numbers by hand. */
#include "hyst/generalized_maxwell_slip.h"

#include "check.h"

#define CLOSE (60.0 * (double)REAL_EPSILON)

static const hyst_real stiffness[] = {R(2.0), R(1.0)};
static const hyst_real share[] = {R(0.5), R(0.5)};

/* Fc = 2, vs = 2, delta = 1, dt = 1/4, C = 4. */
static hyst_generalized_maxwell_slip friction(hyst_real excess, hyst_real viscosity)
{
    hyst_generalized_maxwell_slip model;
    model.count = 2;
    model.stiffness = stiffness;
    model.share = share;
    model.curve.coulomb = R(2.0);
    model.curve.excess = excess;
    model.curve.rate = R(0.5);
    model.shape = R(1.0);
    model.attraction = R(1.0);
    model.viscosity = viscosity;
    model.rate = R(4.0);
    return model;
}

/* Two stops of thresholds 1/2 and 1. */
static void without_a_curve_it_is_maxwell_slip(void)
{
    const hyst_generalized_maxwell_slip model = friction(R(0.0), R(0.0));
    hyst_real state[8] = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
    CHECK_EQUAL(hyst_generalized_maxwell_slip_step(&model, state, R(3.0)), R(0.0));
    CHECK_EQUAL(hyst_generalized_maxwell_slip_step(&model, state, R(3.25)), R(0.75));
    CHECK_EQUAL(hyst_generalized_maxwell_slip_step(&model, state, R(5.0)), R(2.0));
    CHECK_EQUAL(hyst_generalized_maxwell_slip_step(&model, state, R(4.5)), R(0.5));
    CHECK_EQUAL(hyst_generalized_maxwell_slip_step(&model, state, R(2.0)), R(-2.0));
}

/* v = 4: s = 2 + 2 exp(-2). Then v = 8: s = 2 + 2 exp(-4), approached by exp(-C dt / s). Then v = 0. */
static void sliding_approaches_the_curve(void)
{
    const hyst_generalized_maxwell_slip model = friction(R(2.0), R(0.25));
    hyst_real state[8] = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
    const double first = 2.0 + 2.0 * exp(-2.0), then = 2.0 + 2.0 * exp(-4.0);
    hyst_generalized_maxwell_slip_step(&model, state, R(0.0));
    /* The first element meets its half after 0.57 of the way, the second after more than all. */
    CHECK_NEAR((double)hyst_generalized_maxwell_slip_step(&model, state, R(1.0)),
               0.5 * first + 1.0 + 1.0, 4.0 * CLOSE);
    /* The second one begins to slide within this sample, on the curve of its velocity. */
    const double approached = 0.5 * then + (0.5 * first - 0.5 * then) * exp(-1.0 / then);
    CHECK_NEAR((double)hyst_generalized_maxwell_slip_step(&model, state, R(3.0)),
               approached + 0.5 * then + 2.0, 4.0 * CLOSE);
    /* At rest nothing moves, and all stick: */
    CHECK_NEAR((double)hyst_generalized_maxwell_slip_step(&model, state, R(3.0)),
               approached + 0.5 * then, 4.0 * CLOSE);
    CHECK_EQUAL(state[2], R(0.0));
    /* back by 1/8 as springs. */
    CHECK_NEAR((double)hyst_generalized_maxwell_slip_step(&model, state, R(2.875)),
               approached + 0.5 * then - 0.375 - 0.125, 4.0 * CLOSE);
}

/* An element that sticks above what the curve leaves it slides at once, and loses force gradually. */
static void breaking_away_is_gradual(void)
{
    const hyst_generalized_maxwell_slip model = friction(R(2.0), R(0.0));
    hyst_real state[8] = {R(2.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(1.0)};
    const double s = 2.0 + 2.0 * exp(-2.0);
    const double expected = 0.5 * s + (2.0 - 0.5 * s) * exp(-1.0 / s) + 1.0;
    CHECK_NEAR((double)hyst_generalized_maxwell_slip_step(&model, state, R(1.0)), expected,
               4.0 * CLOSE);
}

static void small_ways_add_up(void)
{
    const hyst_generalized_maxwell_slip model = friction(R(0.0), R(0.0));
    hyst_real state[8] = {R(-1.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
    for (size_t k = 0; k <= 1024u; ++k) {
        hyst_generalized_maxwell_slip_step(&model, state, (hyst_real)k * REAL_EPSILON / R(64.0));
    }
    /* k times the way: 2 * 16 epsilon, to a rounding. */
    CHECK_NEAR((double)(state[0] + R(1.0)), 32.0 * (double)REAL_EPSILON,
               1.01 * (double)REAL_EPSILON);
}

static void an_overflow_leaves_the_state(void)
{
    const hyst_generalized_maxwell_slip model = friction(R(2.0), R(0.5));
    hyst_real state[8] = {R(0.5), R(0.0), R(0.0), R(0.25), R(0.0), R(1.0), R(0.0), R(1.0)};
    const hyst_real far = hyst_generalized_maxwell_slip_step(&model, state, REAL_MAX);
    CHECK(!(far - far <= R(0.0)));
    CHECK_EQUAL(state[0], R(0.5));
    CHECK_EQUAL(state[3], R(0.25));
    CHECK_EQUAL(state[5], R(1.0));
    CHECK_EQUAL(state[6], R(0.0));
}

int main(void)
{
    without_a_curve_it_is_maxwell_slip();
    sliding_approaches_the_curve();
    breaking_away_is_gradual();
    small_ways_add_up();
    an_overflow_leaves_the_state();
    return check_result();
}
