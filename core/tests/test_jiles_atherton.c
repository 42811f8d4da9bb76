/* The hysteresis of Jiles and Atherton against a fine quadrature and its own ends. */
#include "hyst/jiles_atherton.h"
#include "hyst/langevin.h"

#include "check.h"

#define KAPPA 2.0

static hyst_jiles_atherton magnet(hyst_jiles_variant variant, int inverse)
{
    hyst_jiles_atherton model; /* Ms = 3, a = 2, k = 1, c = 1/4, alpha = 1 */
    model.variant = variant;
    model.eta = R(1.5);
    model.kappa = R(KAPPA);
    model.c = R(0.25);
    model.field = R(2.0);
    model.level = R(3.0);
    model.x_share = R(0.0);
    model.m_share = R(1.0);
    model.width = R(0.0625);
    model.reach = R(300.0);
    model.loses = 0;
    model.eddy = R(0.0);
    model.excess = R(0.0);
    model.inverse = inverse;
    return model;
}

static double langevin(double x)
{
    return fabs(x) < 1e-3 ? x / 3.0 : 1.0 / tanh(x) - 1.0 / x;
}

/* Of the effective field the pinned part is int kappa L(t) exp(-kappa (x - t)) dt: Simpson's rule of
 * 20000 pieces, (kappa h)^4 / 180 of it: 1e-13. */
static double first_magnetisation(double x)
{
    const double h = x / 20000.0;
    double sum = 0.0;
    for (int i = 0; i <= 20000; ++i) {
        const double t = h * i, weight = i == 0 || i == 20000 ? 1.0 : i % 2 != 0 ? 4.0 : 2.0;
        sum += weight * langevin(t) * exp(-KAPPA * (x - t));
    }
    return 0.25 * langevin(x) + 0.75 * KAPPA * sum * h / 3.0;
}

static void the_initial_curve_is_a_convolution(void)
{
    const hyst_jiles_atherton model = magnet(HYST_JILES_EFFECTIVE_FIELD, 0);
    const double place[] = {0.02, 0.5, 2.0, 6.0, 20.0};
    for (size_t i = 0; i < COUNT(place); ++i) {
        const double m = first_magnetisation(place[i]);
        hyst_real state[HYST_JILES_LENGTH] = {R(0.0)};
        const hyst_real field = (hyst_real)(2.0 * (place[i] - 1.5 * m));
        /* Slope of m over H: at most (1/3) / (1 - 1/2); the sub-steps leave 1e-12. */
        CHECK_NEAR((double)hyst_jiles_atherton_step(&model, state, field), 3.0 * m,
                   1e-11 + 40.0 * (double)REAL_EPSILON);
    }
}

static void after_a_turn_the_pinned_part_rests(void)
{
    const hyst_jiles_variant variant[] = {HYST_JILES_EFFECTIVE_FIELD, HYST_JILES_1992, HYST_JILES_1986};
    for (size_t i = 0; i < COUNT(variant); ++i) {
        const hyst_jiles_atherton model = magnet(variant[i], 0);
        const double reversible = variant[i] == HYST_JILES_1986 ? 0.2 : 0.25;
        hyst_real state[HYST_JILES_LENGTH] = {R(0.0)};
        const double m = (double)hyst_jiles_atherton_step(&model, state, R(3.0)) / 3.0;
        const double x = 1.5 + 1.5 * m;
        const double after = (double)hyst_jiles_atherton_step(&model, state, R(2.0)) / 3.0;
        const double y = 1.0 + 1.5 * after;
        CHECK_NEAR(m - after, reversible * (langevin(x) - langevin(y)), 20.0 * (double)REAL_EPSILON);
    }
}

static void samples_in_between_change_nothing(void)
{
    const hyst_jiles_variant variant[] = {HYST_JILES_EFFECTIVE_FIELD, HYST_JILES_1992, HYST_JILES_1986};
    for (size_t i = 0; i < COUNT(variant); ++i) {
        const hyst_jiles_atherton model = magnet(variant[i], 0);
        hyst_real once[HYST_JILES_LENGTH] = {R(0.0)}, often[HYST_JILES_LENGTH] = {R(0.0)};
        hyst_jiles_atherton_step(&model, once, R(4.0));
        hyst_jiles_atherton_step(&model, often, R(4.0));
        const hyst_real whole = hyst_jiles_atherton_step(&model, once, R(-6.0));
        for (size_t k = 1; k < 500u; ++k) {
            hyst_jiles_atherton_step(&model, often, R(4.0) - (hyst_real)k * R(0.015625));
        }
        CHECK_EQUAL(hyst_jiles_atherton_step(&model, often, R(-6.0)), whole);
    }
}

static void the_inverse_comes_back(void)
{
    const hyst_jiles_variant variant[] = {HYST_JILES_EFFECTIVE_FIELD, HYST_JILES_1992, HYST_JILES_1986};
    const hyst_real field[] = {R(0.1), R(3.0), R(-2.0), R(1.0), R(-7.0), R(-6.5), R(9.0)};
    for (size_t i = 0; i < COUNT(variant); ++i) {
        const hyst_jiles_atherton model = magnet(variant[i], 0), inverse = magnet(variant[i], 1);
        hyst_real there[HYST_JILES_LENGTH] = {R(0.0)}, home[HYST_JILES_LENGTH] = {R(0.0)};
        for (size_t j = 0; j < COUNT(field); ++j) {
            const hyst_real m = hyst_jiles_atherton_step(&model, there, field[j]);
            /* dM/dH is some hundredths at least here: M's rounding over that. */
            CHECK_NEAR((double)hyst_jiles_atherton_step(&inverse, home, m), (double)field[j],
                       4000.0 * (double)REAL_EPSILON);
        }
    }
}

static void far_fields_saturate_and_take_bounded_work(void)
{
    const hyst_jiles_atherton model = magnet(HYST_JILES_EFFECTIVE_FIELD, 0);
    hyst_real state[HYST_JILES_LENGTH] = {R(0.0)};
    const double x = 5e4 + 1.5;
    /* L = 1 - 1/x, and what lags it is below 1 / (kappa x^2). */
    CHECK_NEAR((double)hyst_jiles_atherton_step(&model, state, R(1e5)), 3.0 * (1.0 - 1.0 / x),
               1e-9 + 10.0 * (double)REAL_EPSILON);
    CHECK_NEAR((double)hyst_jiles_atherton_step(&model, state, R(-1e30)), -3.0,
               10.0 * (double)REAL_EPSILON);
}

static void what_no_field_reaches_leaves_the_state(void)
{
    const hyst_jiles_atherton inverse = magnet(HYST_JILES_EFFECTIVE_FIELD, 1);
    const hyst_real beyond[] = {R(3.0), R(-3.0), R(4.0)};
    hyst_real state[HYST_JILES_LENGTH] = {R(0.0)};
    hyst_jiles_atherton_step(&inverse, state, R(1.0));
    for (size_t i = 0; i < COUNT(beyond); ++i) {
        hyst_real kept[HYST_JILES_LENGTH];
        memcpy(kept, state, sizeof state);
        const hyst_real answer = hyst_jiles_atherton_step(&inverse, state, beyond[i]);
        CHECK(!(answer - answer <= R(0.0)));
        CHECK_SAME_BITS(state, kept, HYST_JILES_LENGTH);
    }
}

/* The field within is what the static magnet answers with the same output, and with the losses of the
 * way since the last sample it is the field that was given: level 3, dt = 1/2, a = 2. */
static void losses_are_the_difference_of_the_fields(void)
{
    const hyst_real field[] = {R(1.0), R(4.0), R(4.5), R(4.5), R(2.0), R(-6.0), R(-5.0), R(3.0)};
    const double classical = 0.25, excess = 0.5, dt = 0.5;
    hyst_jiles_atherton model = magnet(HYST_JILES_EFFECTIVE_FIELD, 0), home = model;
    const hyst_jiles_atherton still = model;
    model.loses = 1;
    model.eddy = (hyst_real)(classical * 3.0 / (dt * 2.0));
    model.excess = (hyst_real)(excess * sqrt(3.0 / dt) / 2.0);
    home = model;
    home.inverse = 1;
    hyst_real state[HYST_JILES_LENGTH] = {R(0.0)}, quiet[HYST_JILES_LENGTH] = {R(0.0)};
    hyst_real back[HYST_JILES_LENGTH] = {R(0.0)};
    double last = 0.0;
    for (size_t j = 0; j < COUNT(field); ++j) {
        const hyst_real m = hyst_jiles_atherton_step(&model, state, field[j]);
        const hyst_real within = state[HYST_JILES_INPUT];
        CHECK_NEAR((double)hyst_jiles_atherton_step(&still, quiet, within), (double)m,
                   100.0 * (double)REAL_EPSILON);
        const double rate = ((double)m - last) / dt;
        const double lost = classical * rate + excess * copysign(sqrt(fabs(rate)), rate);
        /* The root of a rate that is known to roundings only, where it is next to none. */
        CHECK_NEAR((double)within + lost, (double)field[j], 4.0 * sqrt((double)REAL_EPSILON));
        CHECK_NEAR((double)hyst_jiles_atherton_step(&home, back, m), (double)field[j],
                   8.0 * sqrt((double)REAL_EPSILON));
        last = (double)m;
    }
}

int main(void)
{
    losses_are_the_difference_of_the_fields();
    the_initial_curve_is_a_convolution();
    after_a_turn_the_pinned_part_rests();
    samples_in_between_change_nothing();
    the_inverse_comes_back();
    far_fields_saturate_and_take_bounded_work();
    what_no_field_reaches_leaves_the_state();
    return check_result();
}
