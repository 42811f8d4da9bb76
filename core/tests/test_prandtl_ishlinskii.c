#include "check.h"

/* By hand: y = 0.5 u + 1 z_1 + 2 z_2 with thresholds 1 and 2. Rising to 4 the plays end at 3 and 2;
 * falling to 1 the first is dragged to 2 and the second touches at 1 + 2 = 3 > 2 and rests. */
static void follows_hand_calculation(void)
{
    const hyst_real p[] = {R(1.0), R(2.0)};
    const hyst_real r[] = {R(1.0), R(2.0)};
    const hyst_pi pi = {2, R(0.5), p, r};
    const hyst_real u[] = {R(1.0), R(2.0), R(4.0), R(4.0), R(1.0), R(-1.0), R(-4.0), R(0.0)};
    const hyst_real z1[] = {R(0.0), R(1.0), R(3.0), R(3.0), R(2.0), R(0.0), R(-3.0), R(-1.0)};
    const hyst_real z2[] = {R(0.0), R(0.0), R(2.0), R(2.0), R(2.0), R(1.0), R(-2.0), R(-2.0)};
    const hyst_real y[] = {R(0.5), R(2.0), R(9.0), R(9.0), R(6.5), R(1.5), R(-9.0), R(-5.0)};
    hyst_real z[] = {R(0.0), R(0.0)};
    for (size_t k = 0; k < COUNT(u); ++k) {
        CHECK_EQUAL(hyst_pi_step(&pi, z, u[k]), y[k]);
        CHECK_EQUAL(z[0], z1[k]);
        CHECK_EQUAL(z[1], z2[k]);
    }
}

static void no_plays_leave_the_linear_part(void)
{
    const hyst_pi pi = {0, R(0.5), NULL, NULL};
    CHECK_EQUAL(hyst_pi_step(&pi, NULL, R(3.0)), R(1.5));
}

static void thresholds_may_repeat_and_come_in_any_order(void)
{
    const hyst_real p[] = {R(2.0), R(1.0), R(1.0)};
    const hyst_real r[] = {R(2.0), R(0.0), R(2.0)};
    const hyst_pi pi = {3, R(0.0), p, r};
    hyst_real z[] = {R(0.0), R(0.0), R(0.0)};
    CHECK_EQUAL(hyst_pi_step(&pi, z, R(5.0)), R(14.0));  /* 2 3 + 5 + 3 */
    CHECK_EQUAL(hyst_pi_step(&pi, z, R(2.0)), R(11.0)); /* 2 3 + 2 + 3: both wide plays rest */
}

/* Plays of threshold 0 pass the input on, so at u = 1 the output is the sum of the weights. */
static hyst_real sum_of_weights(size_t count, hyst_real p0, const hyst_real *p)
{
    const hyst_real r[19] = {R(0.0)};
    const hyst_pi pi = {count, p0, p, r};
    hyst_real z[19] = {R(0.0)};
    return hyst_pi_step(&pi, z, R(1.0));
}

/* huge + 1 and huge - 1 round to huge, huge + 4 is a number; so a sum tells its order. */
static void plays_are_summed_in_their_order(void)
{
    const hyst_real huge = R(4.0) / REAL_EPSILON;
    hyst_real p[19];
    for (size_t i = 0; i < COUNT(p); ++i) {
        p[i] = R(1.0);
    }
    CHECK_EQUAL(sum_of_weights(15, huge, p), huge);           /* one by one */
    CHECK_EQUAL(sum_of_weights(16, huge, p), huge + R(16.0)); /* 4 in each sum, then huge + 16 */
    CHECK_EQUAL(sum_of_weights(19, huge, p), huge + R(16.0)); /* the last three one by one */
    for (size_t i = 0; i < COUNT(p); ++i) {
        p[i] = R(0.0);
    }
    p[0] = huge, p[1] = R(1.0), p[2] = -huge, p[3] = R(1.0); /* (huge - huge) + (1 + 1) */
    CHECK_EQUAL(sum_of_weights(16, R(0.0), p), R(2.0));
    p[0] = huge, p[1] = R(0.0), p[2] = R(0.0), p[3] = R(0.0);
    p[4] = R(1.0), p[8] = -huge, p[12] = R(1.0); /* ((huge + 1) - huge) + 1, all in s_0 */
    CHECK_EQUAL(sum_of_weights(16, R(0.0), p), R(1.0));
    p[16] = huge, p[17] = R(1.0), p[18] = -huge; /* ((1 + huge) + 1) - huge */
    CHECK_EQUAL(sum_of_weights(19, R(0.0), p), R(0.0));
}

/* Every play of a wide bank, against a bank of that play alone. */
static void wide_banks_move_every_play(void)
{
    hyst_real p[19], r[19], z[19], alone[19];
    for (size_t i = 0; i < COUNT(p); ++i) {
        p[i] = R(0.0);
        r[i] = R(0.25) * (hyst_real)i;
        z[i] = alone[i] = R(0.0);
    }
    const hyst_pi wide = {COUNT(p), R(0.5), p, r};
    hyst_real u[200];
    fill_with_noise(u, COUNT(u), R(6.0));
    for (size_t k = 0; k < COUNT(u); ++k) {
        p[k % COUNT(p)] = R(1.0);
        const hyst_real y = hyst_pi_step(&wide, z, u[k]);
        p[k % COUNT(p)] = R(0.0);
        for (size_t i = 0; i < COUNT(p); ++i) {
            (void)hyst_play_step(r[i], &alone[i], u[k]);
        }
        CHECK_SAME_BITS(z, alone, COUNT(z));
        CHECK_EQUAL(y, R(0.5) * u[k] + alone[k % COUNT(p)]);
    }
}

/* The example of S1 sec. 5.2 with its inverse by S1 eqs. 7-8, calculated here. The expected digits
 * are those the equations give from the printed p; the paper's own last two weights and last
 * threshold come from unrounded p. */
enum { plays = 10, samples = 2000 };

typedef struct {
    hyst_real p[plays], r[plays], g[plays], s[plays];
    hyst_real p0, g0;
} example;

static example example_with_inverse(void)
{
    static const double p[plays] = {.0462, .069, .1029, .1535, .2291, .3417, .51, .761, 1.1, 1.7};
    static const double g_expected[plays] = {-3.160, -2.193, -1.503, -1.023, -0.693,
                                             -0.468, -0.315, -0.212, -0.139, -0.097};
    static const double s_expected[plays] = {0.4,   0.985,  1.846,  3.118, 5.004,
                                             7.807, 11.977, 18.186, 27.44, 41.09};
    example made;
    double sum_before = 0.1, s = 0.0;
    made.p0 = R(0.1);
    made.g0 = R(10.0);
    for (size_t i = 0; i < plays; ++i) {
        const double sum = sum_before + p[i];
        const double g = -p[i] / (sum * sum_before);
        s += sum_before * 4.0;
        CHECK_NEAR(g, g_expected[i], 0.5e-3 + 1e-9); /* half a unit of the last digit given */
        CHECK_NEAR(s, s_expected[i], i < 8 ? 0.5e-3 + 1e-9 : 0.5e-2 + 1e-9);
        made.p[i] = (hyst_real)p[i];
        made.r[i] = (hyst_real)(4.0 * (double)(i + 1));
        made.g[i] = (hyst_real)g;
        made.s[i] = (hyst_real)s;
        sum_before = sum;
    }
    return made;
}

static void inverse_gives_the_input_back(void)
{
    const example e = example_with_inverse();
    const hyst_pi forward = {plays, e.p0, e.p, e.r};
    const hyst_pi inverse = {plays, e.g0, e.g, e.s};
    static hyst_real u[samples];
    hyst_real z[plays] = {R(0.0)}, w[plays] = {R(0.0)};
    /* With |u| <= 50, |y| <= 150, every exact partial sum of the inverse is at most
     * (g0 + sum |g|) 150 = 3000, and an error of y counts g0 = 10 times. So the error is a few
     * roundings of numbers up to 3000 on a range of 100: 11 terms x 30 x epsilon of range, which
     * is 7e-14 in double, inside the 1e-12 demanded, and 4e-5 in float. */
    const double range = 100.0;
    const double tolerance = sizeof(hyst_real) == 8 ? 1e-12 : 11.0 * 30.0 * (double)REAL_EPSILON;
    fill_with_noise(u, samples, R(50.0));
    for (size_t k = 0; k < samples; ++k) {
        const hyst_real y = hyst_pi_step(&forward, z, u[k]);
        CHECK(fabs((double)y) <= 150.0);
        CHECK_NEAR((double)hyst_pi_step(&inverse, w, y) / range, (double)u[k] / range, tolerance);
    }
}

int main(void)
{
    follows_hand_calculation();
    no_plays_leave_the_linear_part();
    thresholds_may_repeat_and_come_in_any_order();
    plays_are_summed_in_their_order();
    wide_banks_move_every_play();
    inverse_gives_the_input_back();
    return check_result();
}
