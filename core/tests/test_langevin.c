/* The Langevin function against series and what it must satisfy. */
#include "hyst/langevin.h"

#include "check.h"

/* x/3 - x^3/45 + 2 x^5/945 - x^7/4725, enough below 0.02: the next term is 2 x^9 / 93555. */
static void its_series_near_zero(void)
{
    const double place[] = {0.0, 1e-30, 1e-9, 1e-4, 0.003, 0.02};
    for (size_t i = 0; i < COUNT(place); ++i) {
        const double x = (double)(hyst_real)place[i], s = x * x;
        const double value = x * (1.0 / 3.0 - s * (1.0 / 45.0 - s * (2.0 / 945.0 - s / 4725.0)));
        const double slope = 1.0 / 3.0 - s * (1.0 / 15.0 - s * (2.0 / 189.0 - s * 7.0 / 4725.0));
        CHECK_NEAR((double)hyst_langevin((hyst_real)x), value, 4.0 * (double)REAL_EPSILON * value);
        CHECK_NEAR((double)hyst_langevin((hyst_real)-x), -value, 4.0 * (double)REAL_EPSILON * value);
        /* 1 - 2/3: the sum of two of size 1 rounds by an epsilon. */
        CHECK_NEAR((double)hyst_langevin_slope((hyst_real)x), slope, 2.0 * (double)REAL_EPSILON);
    }
}

/* coth x - 1/x by the host's tanh, which is good where nothing cancels. */
static void its_formula_elsewhere(void)
{
    const double place[] = {0.7, 1.0, 1.4999, 1.5001, 2.0, 5.0, 40.0, 1e3, 1e6};
    for (size_t i = 0; i < COUNT(place); ++i) {
        const double x = (double)(hyst_real)place[i];
        const double sinh2 = x < 300.0 ? sinh(x) * sinh(x) : INFINITY;
        CHECK_NEAR((double)hyst_langevin((hyst_real)x), 1.0 / tanh(x) - 1.0 / x,
                   8.0 * (double)REAL_EPSILON);
        CHECK_NEAR((double)hyst_langevin_slope((hyst_real)x), 1.0 / (x * x) - 1.0 / sinh2,
                   8.0 * (double)REAL_EPSILON);
    }
}

static void its_inverse(void)
{
    const double place[] = {1e-20, 1e-3, 0.3, 1.0, 1.5, 3.0, 12.0, 200.0};
    for (size_t i = 0; i < COUNT(place); ++i) {
        const hyst_real x = (hyst_real)place[i];
        const double slope = (double)hyst_langevin_slope(x);
        /* What L is rounded by, over its slope, and the solution itself. */
        const double near = (double)REAL_EPSILON * (4.0 * (double)hyst_langevin(x) / slope + (double)x);
        CHECK_NEAR((double)hyst_langevin_inverse(hyst_langevin(x)), (double)x, 2.0 * near);
        CHECK_NEAR((double)hyst_langevin_inverse(hyst_langevin(-x)), (double)-x, 2.0 * near);
    }
    CHECK(hyst_langevin_inverse(R(1.0)) > R(1e6));
    CHECK_EQUAL(hyst_langevin_inverse(R(1.0)), hyst_langevin_inverse(R(7.0)));
    CHECK_EQUAL(hyst_langevin_inverse(R(0.0)), R(0.0));
}

int main(void)
{
    its_series_near_zero();
    its_formula_elsewhere();
    its_inverse();
    return check_result();
}
