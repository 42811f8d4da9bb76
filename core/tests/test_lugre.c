/* LuGre friction against numbers by hand. */
#include "hyst/lugre.h"

#include "check.h"

#define CLOSE (60.0 * (double)REAL_EPSILON)

/* sigma0 = 2, Fc = 1, vs = 2, dt = 1/4. */
static hyst_lugre friction(hyst_real excess, hyst_real damping, hyst_real viscosity)
{
    hyst_lugre model;
    model.stiffness = R(2.0);
    model.damping = damping;
    model.viscosity = viscosity;
    model.thinning = R(0.0);
    model.thin = R(0.25);
    model.curve.coulomb = R(1.0);
    model.curve.excess = excess;
    model.curve.rate = R(0.5);
    model.rate = R(4.0);
    return model;
}

static void begin(hyst_real *state)
{
    for (size_t i = 0; i < 4u; ++i) {
        state[i] = R(0.0);
    }
}

/* Without curve and damping Dahl's: 1 - exp(-1), and back by the same way. */
static void without_a_curve_it_is_dahls(void)
{
    const hyst_lugre model = friction(R(0.0), R(0.0), R(0.0));
    hyst_real state[4];
    begin(state);
    CHECK_EQUAL(hyst_lugre_step(&model, state, R(7.0)), R(0.0));
    CHECK_NEAR((double)hyst_lugre_step(&model, state, R(7.5)), 0.6321205588285577, CLOSE);
    CHECK_NEAR((double)hyst_lugre_step(&model, state, R(7.0)), -0.39957640089372803, CLOSE);
}

/* v = 2 = vs: s = 1 + exp(-1) = 1.367879441, x = 1 / s, w = s (1 - exp(-x)) = 0.7093483795;
 * F = w + 3 v (1 - w / s) + 1/2 v = 0.70934838 + 6 * 0.48142480 + 1. */
static void every_term_by_hand(void)
{
    const hyst_lugre model = friction(R(1.0), R(3.0), R(0.5));
    hyst_real state[4];
    begin(state);
    hyst_lugre_step(&model, state, R(0.0));
    const double s = 1.0 + exp(-1.0), w = s * (1.0 - exp(-1.0 / s));
    const double expected = w + 6.0 * (1.0 - w / s) + 1.0;
    CHECK_NEAR((double)hyst_lugre_step(&model, state, R(0.5)), expected, CLOSE * expected);
    /* v = -2, and 3 tanh(v / 4) more: tanh(1/2) = 0.46211715726. */
    hyst_lugre thinning = model;
    hyst_real other[4] = {state[0], state[1], state[2], state[3]};
    thinning.thinning = R(3.0);
    hyst_real plain[4] = {state[0], state[1], state[2], state[3]};
    const double more = (double)(hyst_lugre_step(&thinning, other, R(0.0)) -
                                 hyst_lugre_step(&model, plain, R(0.0)));
    CHECK_NEAR(more, -3.0 * 0.46211715726000976, 20.0 * CLOSE);
    /* At rest only the bristles are left. */
    CHECK_NEAR((double)hyst_lugre_step(&model, state, R(0.5)), w, CLOSE);
}

/* Slow sliding bears Fs = 2, fast sliding Fc = 1, viscosity apart. */
static void sliding_follows_the_curve(void)
{
    const hyst_lugre model = friction(R(1.0), R(3.0), R(0.0));
    hyst_real state[4];
    hyst_real force = R(0.0);
    begin(state);
    for (size_t k = 0; k < 40000u; ++k) {
        force = hyst_lugre_step(&model, state, (hyst_real)k / R(1024.0));
    }
    /* v = 1/256: s = 2 - (v / vs)^2 = 2 - 3.8e-6. */
    CHECK_NEAR((double)force, 2.0 - 3.8147e-6, 1e-9 + CLOSE);
    CHECK_NEAR((double)hyst_lugre_step(&model, state, R(-1e6)), -1.0, CLOSE);
}

/* Ways that are nothing beside the force add up: 1000 of a 64th of its last place. */
static void small_ways_add_up(void)
{
    const hyst_lugre model = friction(R(0.0), R(0.0), R(0.0));
    hyst_real state[4], once[4];
    begin(state);
    begin(once);
    state[1] = once[1] = R(-0.5);
    for (size_t k = 0; k <= 1000u; ++k) {
        hyst_lugre_step(&model, state, (hyst_real)k * REAL_EPSILON / R(64.0));
    }
    hyst_lugre_step(&model, once, R(0.0));
    hyst_lugre_step(&model, once, R(1000.0) * REAL_EPSILON / R(64.0));
    CHECK(state[1] > R(-0.5));
    CHECK_NEAR((double)state[1], (double)once[1], 1.01 * (double)REAL_EPSILON);
}

static void an_overflow_leaves_the_state(void)
{
    const hyst_lugre model = friction(R(1.0), R(3.0), R(0.5));
    hyst_real state[4];
    begin(state);
    hyst_lugre_step(&model, state, R(0.0));
    hyst_lugre_step(&model, state, R(0.5));
    const hyst_real before[4] = {state[0], state[1], state[2], state[3]};
    const hyst_real far = hyst_lugre_step(&model, state, REAL_MAX);
    CHECK(!(far - far <= R(0.0)));
    for (size_t i = 0; i < 4u; ++i) {
        CHECK_EQUAL(state[i], before[i]);
    }
}

int main(void)
{
    without_a_curve_it_is_dahls();
    every_term_by_hand();
    sliding_follows_the_curve();
    small_ways_add_up();
    an_overflow_leaves_the_state();
    return check_result();
}
