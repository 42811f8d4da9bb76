#include "check.h"

/* By hand: y = 0.5 u + 1 z_1 + 2 z_2, thresholds 1 and 2, widening 0.5 |u_k - u_{k-1}|.
 *   u      b     bounds 1       bounds 2        z_1    z_2     y
 *   4      0     3 .. 5         2 .. 6          3      2       9      first sample: no rate
 *   8      2     5 .. 11        4 .. 12         5      4      17
 *   8      0     7 .. 9         6 .. 10         7      6      23      rest: the bounds close in
 *   2      3    -2 .. 6        -3 .. 7          6      6      19
 *   0      1    -2 .. 2        -3 .. 3          2      3       8
 *  -4      2    -7 .. -1       -8 .. 0         -1      0      -3 */
static void follows_hand_calculation(void)
{
    const hyst_real p[] = {R(1.0), R(2.0)};
    const hyst_real r[] = {R(1.0), R(2.0)};
    const hyst_rate_dependent_pi model = {{2, R(0.5), p, r}, R(0.5), 0, NULL, {0, NULL, NULL}};
    const hyst_real u[] = {R(4.0), R(8.0), R(8.0), R(2.0), R(0.0), R(-4.0)};
    const hyst_real z1[] = {R(3.0), R(5.0), R(7.0), R(6.0), R(2.0), R(-1.0)};
    const hyst_real z2[] = {R(2.0), R(4.0), R(6.0), R(6.0), R(3.0), R(0.0)};
    const hyst_real y[] = {R(9.0), R(17.0), R(23.0), R(19.0), R(8.0), R(-3.0)};
    hyst_real state[] = {R(0.0), R(0.0), R(0.0), R(0.0)};
    for (size_t k = 0; k < COUNT(u); ++k) {
        CHECK_EQUAL(hyst_rate_dependent_pi_step(&model, state, u[k]), y[k]);
        CHECK_EQUAL(state[0], z1[k]);
        CHECK_EQUAL(state[1], z2[k]);
        CHECK_EQUAL(state[2], u[k]);
        CHECK_EQUAL(state[3], R(1.0));
    }
}

/* g(x) = x + 0.5 x^2 + 0.25 x^3 + 2 max(x - 1, 0) - 0.5 max(x - 3, 0), at powers of two. */
static void widening_follows_its_curve(void)
{
    const hyst_real power[] = {R(0.5), R(0.25)};
    const hyst_real weight[] = {R(2.0), R(-0.5)};
    const hyst_real threshold[] = {R(1.0), R(3.0)};
    const hyst_rate_dependent_pi model = {
        {0, R(1.0), NULL, NULL}, R(1.0), 2, power, {2, weight, threshold}};
    CHECK_EQUAL(hyst_widening(&model, R(0.0)), R(0.0));
    CHECK_EQUAL(hyst_widening(&model, R(0.5)), R(0.65625));  /* 0.5 + 0.125 + 0.03125 */
    CHECK_EQUAL(hyst_widening(&model, R(2.0)), R(8.0));      /* 2 + 2 + 2 + 2 */
    CHECK_EQUAL(hyst_widening(&model, R(4.0)), R(33.5));     /* 4 + 8 + 16 + 6 - 0.5 */
}

/* A jump from one end of the number range to the other has no finite rate; 0 times it is no
 * number. Neither may enter the state. */
static void state_stays_finite_when_the_rate_overflows(void)
{
    const hyst_real p[] = {R(1.0)};
    const hyst_real r[] = {R(1.0)};
    hyst_rate_dependent_pi model = {{1, R(0.0), p, r}, R(0.0), 0, NULL, {0, NULL, NULL}};
    for (int rate_dependent = 0; rate_dependent < 2; ++rate_dependent) {
        hyst_real state[] = {R(0.0), R(0.0), R(0.0)};
        model.growth = rate_dependent ? R(1.0) : R(0.0);
        hyst_rate_dependent_pi_step(&model, state, REAL_MAX);
        hyst_rate_dependent_pi_step(&model, state, -REAL_MAX);
        CHECK(hyst_is_finite(state[0]));
        CHECK(hyst_is_finite(state[1]));
    }
}

/* With growth 0 it is the operator of constant thresholds, bit for bit. */
static void without_growth_it_is_rate_independent(void)
{
    enum { samples = 1000 };
    const hyst_real p[] = {R(0.3), R(0.7), R(-0.1)};
    const hyst_real r[] = {R(0.1), R(0.9), R(2.3)};
    const hyst_pi pi = {3, R(0.2), p, r};
    const hyst_rate_dependent_pi model = {pi, R(0.0), 0, NULL, {0, NULL, NULL}};
    static hyst_real u[samples];
    hyst_real z[] = {R(0.0), R(0.0), R(0.0)};
    hyst_real state[] = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
    fill_with_noise(u, samples, R(3.0));
    for (size_t k = 0; k < samples; ++k) {
        CHECK_EQUAL(hyst_rate_dependent_pi_step(&model, state, u[k]), hyst_pi_step(&pi, z, u[k]));
    }
}

int main(void)
{
    follows_hand_calculation();
    widening_follows_its_curve();
    state_stays_finite_when_the_rate_overflows();
    without_growth_it_is_rate_independent();
    return check_result();
}
