/* A play as wide as a power of the rate against numbers by hand. */
#include "hyst/rate_shift.h"

#include "check.h"

#define CLOSE (40.0 * (double)REAL_EPSILON)

/* c = 1/2, m = 1/2, dt = 1/4: steps of 1 are a rate of 4 and a width of 1. */
static hyst_rate_shift root(void)
{
    hyst_rate_shift model;
    model.shift = R(0.5);
    model.exponent = R(0.5);
    model.per_time = R(4.0);
    return model;
}

static void the_output_follows_at_the_width_of_the_rate(void)
{
    const hyst_rate_shift model = root();
    hyst_real state[3] = {R(0.0), R(0.0), R(0.0)};
    const double u[] = {0.0, 1.0, 2.0, 3.0, 2.75, 2.5, -0.5, -0.5};
    /* Steps of 1/4 are a rate of 1 and a width of 1/2, one of 3 a rate of 12 and a width of
     * sqrt(3), and at rest nothing is left of it. */
    const double z[] = {0.0, 0.0, 1.0, 2.0, 2.25, 2.25, 1.2320508075688772, -0.5};
    for (size_t i = 0; i < COUNT(u); ++i) {
        CHECK_NEAR((double)hyst_rate_shift_step(&model, state, (hyst_real)u[i]), z[i], CLOSE);
    }
}

static void the_first_sample_is_at_rest(void)
{
    const hyst_rate_shift model = root();
    hyst_real state[3] = {R(0.0), R(0.0), R(0.0)};
    CHECK_EQUAL(hyst_rate_shift_step(&model, state, R(7.0)), R(7.0));
}

static void without_a_shift_it_is_the_input(void)
{
    hyst_rate_shift model = root();
    hyst_real state[3] = {R(0.0), R(0.0), R(0.0)};
    model.shift = R(0.0);
    CHECK_EQUAL(hyst_rate_shift_step(&model, state, R(3.0)), R(3.0));
    CHECK_EQUAL(hyst_rate_shift_step(&model, state, R(-2.0)), R(-2.0));
}

static void a_width_that_is_no_number_is_none(void)
{
    hyst_rate_shift model = root();
    hyst_real state[3] = {R(0.0), R(0.0), R(1.0)};
    model.shift = REAL_MAX;
    model.exponent = R(3.0);
    CHECK_EQUAL(hyst_rate_shift_step(&model, state, R(1e9)), R(1e9));
}

int main(void)
{
    the_output_follows_at_the_width_of_the_rate();
    the_first_sample_is_at_rest();
    without_a_shift_it_is_the_input();
    a_width_that_is_no_number_is_none();
    return check_result();
}
