#include "check.h"

/* By hand: y = 0.5 u + 2 max(u - 1, 0) + 4 min(u + 2, 0). */
static void two_sided_follows_hand_calculation(void)
{
    const hyst_real weight[] = {R(0.5), R(2.0), R(4.0)};
    const hyst_real threshold[] = {R(0.0), R(1.0), R(-2.0)};
    const hyst_dead_zone map = {3, weight, threshold};
    CHECK_EQUAL(hyst_dead_zone_step(&map, R(0.0)), R(0.0));
    CHECK_EQUAL(hyst_dead_zone_step(&map, R(0.5)), R(0.25));
    CHECK_EQUAL(hyst_dead_zone_step(&map, R(1.0)), R(0.5)); /* on the threshold */
    CHECK_EQUAL(hyst_dead_zone_step(&map, R(3.0)), R(5.5));
    CHECK_EQUAL(hyst_dead_zone_step(&map, R(-2.0)), R(-1.0)); /* on the threshold */
    CHECK_EQUAL(hyst_dead_zone_step(&map, R(-5.0)), R(-14.5));
}

static void no_terms_give_zero(void)
{
    const hyst_dead_zone map = {0, NULL, NULL};
    hyst_real u_previous = R(1.0);
    CHECK_EQUAL(hyst_dead_zone_step(&map, R(3.0)), R(0.0));
    CHECK_EQUAL(hyst_direction_dead_zone_step(&map, &u_previous, R(3.0)), R(0.0));
    CHECK_EQUAL(u_previous, R(3.0));
}

static void negative_zero_is_a_zero_threshold(void)
{
    const hyst_real weight[] = {R(2.0)};
    const hyst_real threshold[] = {-R(0.0)};
    const hyst_dead_zone map = {1, weight, threshold};
    CHECK_EQUAL(hyst_dead_zone_step(&map, R(1.5)), R(3.0));
    CHECK_EQUAL(hyst_dead_zone_step(&map, R(-1.5)), R(-3.0));
}

/* S0 eq. 3 with threshold 1: u - 1 while rising above 1, u + 1 while falling below -1, else 0.
 * On the way down from 3 to 2 the input is above the threshold, but falling: 0, as printed. */
static void by_direction_follows_printed_equation(void)
{
    const hyst_real weight[] = {R(1.0)};
    const hyst_real threshold[] = {R(1.0)};
    const hyst_dead_zone map = {1, weight, threshold};
    const hyst_real u[] = {R(0.5), R(1.0), R(2.0), R(3.0), R(3.0),
                           R(2.0), R(0.0), R(-1.0), R(-2.5), R(-2.0), R(1.5)};
    const hyst_real y[] = {R(0.0), R(0.0), R(1.0), R(2.0), R(0.0),
                           R(0.0), R(0.0), R(0.0), R(-1.5), R(0.0), R(0.5)};
    hyst_real u_previous = R(0.0);
    for (size_t k = 0; k < COUNT(u); ++k) {
        CHECK_EQUAL(hyst_direction_dead_zone_step(&map, &u_previous, u[k]), y[k]);
        CHECK_EQUAL(u_previous, u[k]);
    }
}

/* S0 eq. 3 with threshold -1: rising, u + 1 as soon as u > -1; falling, u - 1 as soon as u < 1. */
static void by_direction_takes_negative_thresholds(void)
{
    const hyst_real weight[] = {R(1.0), R(2.0)};
    const hyst_real threshold[] = {R(-1.0), R(0.0)};
    const hyst_dead_zone map = {2, weight, threshold};
    hyst_real u_previous = R(0.0);
    CHECK_EQUAL(hyst_direction_dead_zone_step(&map, &u_previous, R(0.5)), R(2.5));
    CHECK_EQUAL(hyst_direction_dead_zone_step(&map, &u_previous, R(0.25)), R(-0.75));
    CHECK_EQUAL(hyst_direction_dead_zone_step(&map, &u_previous, R(-4.0)), R(-13.0));
    CHECK_EQUAL(hyst_direction_dead_zone_step(&map, &u_previous, R(-2.0)), R(0.0));
}

/* The envelope of S1 sec. 5.2 and its inverse by S1 eqs. 53-55, calculated here. Of the numbers S1
 * prints, two are not what its equations give: psi_1 is 4.914 (printed 4.94), eps_1 -0.3620
 * (printed -0.361). */
static void inverse_envelope_gives_the_input_back(void)
{
    const double xi[] = {0.65, 0.2, 0.3, 0.4};
    const double rho[] = {0.0, 7.56, 12.0, 17.69};
    const double psi_expected[] = {0.0, 4.914, 8.688, 15.2315};
    const double eps_expected[] = {1.5385, -0.3620, -0.3069, -0.2244};
    hyst_real weight[4], threshold[4], inverse_weight[4], inverse_threshold[4];
    double slope_before = 0.0, psi = 0.0;
    for (size_t i = 0; i < 4; ++i) {
        const double slope = slope_before + xi[i];
        psi += i == 0 ? 0.0 : slope_before * (rho[i] - rho[i - 1]);
        const double eps = i == 0 ? 1.0 / slope : 1.0 / slope - 1.0 / slope_before;
        CHECK_NEAR(psi, psi_expected[i], 0.5e-4); /* half a unit of the last digit given */
        CHECK_NEAR(eps, eps_expected[i], 0.5e-4);
        weight[i] = (hyst_real)xi[i];
        threshold[i] = (hyst_real)rho[i];
        inverse_weight[i] = (hyst_real)eps;
        inverse_threshold[i] = (hyst_real)psi;
        slope_before = slope;
    }
    const hyst_dead_zone envelope = {4, weight, threshold};
    const hyst_dead_zone inverse = {4, inverse_weight, inverse_threshold};
    for (int k = 0; k <= 60; ++k) {
        const hyst_real u = (hyst_real)k / R(2.0);
        const hyst_real back = hyst_dead_zone_step(&inverse, hyst_dead_zone_step(&envelope, u));
        /* At most 30 in, 30 through and sum(|eps|) 30 out: some 100 of sums of 4 rounded terms. */
        CHECK_NEAR((double)back, (double)u, 400.0 * (double)REAL_EPSILON);
    }
}

int main(void)
{
    two_sided_follows_hand_calculation();
    no_terms_give_zero();
    negative_zero_is_a_zero_threshold();
    by_direction_follows_printed_equation();
    by_direction_takes_negative_thresholds();
    inverse_envelope_gives_the_input_back();
    return check_result();
}
