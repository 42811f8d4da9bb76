#include "check.h"

/* By hand: 3 1 pool to 2 2; then 2 2 2 with 2 below 5; 5 1 pool to 3 3, which stay above 2. */
static void pools_what_descends(void)
{
    hyst_real x[] = {R(3.0), R(1.0), R(2.0), R(5.0), R(1.0)};
    const hyst_real expected[] = {R(2.0), R(2.0), R(2.0), R(3.0), R(3.0)};
    hyst_isotonic(COUNT(x), x, R(0.0), R(10.0));
    CHECK_SAME_BITS(x, expected, COUNT(x));
}

/* 4 2 pool to 3; the 0 after them takes all three down to 2. */
static void a_pool_grows_backwards(void)
{
    hyst_real x[] = {R(1.0), R(4.0), R(2.0), R(0.0), R(9.0)};
    const hyst_real expected[] = {R(1.0), R(2.0), R(2.0), R(2.0), R(9.0)};
    hyst_isotonic(COUNT(x), x, R(0.0), R(10.0));
    CHECK_SAME_BITS(x, expected, COUNT(x));
}

static void bounds_come_last(void)
{
    hyst_real x[] = {R(-3.0), R(1.0), R(7.0)};
    const hyst_real expected[] = {R(0.0), R(1.0), R(5.0)};
    hyst_isotonic(COUNT(x), x, R(0.0), R(5.0));
    CHECK_SAME_BITS(x, expected, COUNT(x));
    hyst_isotonic(0, x, R(0.0), R(5.0));
}

/* By hand: with weights 1 / gain of 1 and 3 the pool of 4 0 is (4 + 3 * 0) / 4; a gain of 0 yields to
 * none, from either side. */
static void a_small_gain_yields_less(void)
{
    const hyst_real gain[] = {R(3.0), R(1.0)};
    const hyst_real fixed_last[] = {R(3.0), R(0.0)};
    const hyst_real fixed_first[] = {R(0.0), R(1.0)};
    const hyst_real expected[][2] = {{R(1.0), R(1.0)}, {R(0.5), R(0.5)}, {R(4.0), R(4.0)}};
    hyst_real x[] = {R(4.0), R(0.0)};
    hyst_real y[] = {R(4.0), R(0.5)};
    hyst_real z[] = {R(4.0), R(0.5)};
    hyst_isotonic_weighted(2, x, gain, R(0.0), R(10.0));
    CHECK_NEAR(x[0], expected[0][0], 4.0 * (double)REAL_EPSILON);
    CHECK(!(x[0] < x[1] || x[0] > x[1]));
    hyst_isotonic_weighted(2, y, fixed_last, R(0.0), R(10.0));
    CHECK_SAME_BITS(y, expected[1], 2);
    hyst_isotonic_weighted(2, z, fixed_first, R(0.0), R(10.0));
    CHECK_SAME_BITS(z, expected[2], 2);
}

/* The projection P of a point x onto a convex set is the one point of it with
 * (x - P)' (q - P) <= 0 for every q of the set. The set is a cone, so q = 0, q = 2 P and its rays
 * (0 .. 0 1 .. 1) are enough. */
static void is_the_nearest_point(void)
{
    enum { count = 7, trials = 300 };
    static hyst_real given[trials * count];
    fill_with_noise(given, trials * count, R(4.0));
    for (size_t trial = 0; trial < trials; ++trial) {
        const hyst_real *x = given + trial * count;
        hyst_real projected[count];
        memcpy(projected, x, sizeof projected);
        hyst_isotonic(count, projected, R(0.0), R(100.0));
        double along = 0.0;
        double tail = 0.0;
        for (size_t i = count; i-- > 0;) {
            const double rest = (double)x[i] - (double)projected[i];
            along += rest * (double)projected[i];
            tail += rest; /* along the ray that starts at i */
            CHECK(tail <= 100.0 * (double)REAL_EPSILON);
            CHECK(i == 0 || projected[i - 1] <= projected[i]);
        }
        CHECK(projected[0] >= R(0.0));
        /* 7 products of numbers below 4, each rounded. */
        CHECK_NEAR(along, 0.0, 500.0 * (double)REAL_EPSILON);
    }
}

int main(void)
{
    pools_what_descends();
    a_pool_grows_backwards();
    bounds_come_last();
    a_small_gain_yields_less();
    is_the_nearest_point();
    return check_result();
}
