/* The way along a piece against the output it came from, and the share left of an exponential. */
#include "hyst/coleman_hodgdon.h"

#include "check.h"

static void a_share_has_all_its_digits(void)
{
    /* 1 - exp(-x) by the libm of the host, which is within a rounding of it. */
    const double x[] = {0.0, 1e-12, 1e-3, 0.2, 0.2499, 0.2501, 1.0, 5.0, 40.0, 900.0};
    for (size_t i = 0; i < COUNT(x); ++i) {
        const double share = (double)hyst_coleman_share((hyst_real)x[i]);
        const double truth = -expm1(-(double)(hyst_real)x[i]);
        /* Four roundings of the result, and beyond 1/4 of 1: the power says 4 + 2 |e log2 x|. */
        CHECK_NEAR(share, truth, 8.0 * (double)REAL_EPSILON * truth);
    }
}

static void the_way_leads_to_the_output(void)
{
    const struct {
        double line, bend;
    } piece[] = {{1.0, -0.5}, {1.0, -0.999}, {0.3, 2.0}, {1e-3, 1.0}, {1.0, 0.0}, {5.0, -4.999}};
    const double way[] = {1e-9, 1e-4, 0.02, 0.7, 3.0, 30.0, 500.0};
    for (size_t i = 0; i < COUNT(piece); ++i) {
        for (size_t j = 0; j < COUNT(way); ++j) {
            const hyst_real line = (hyst_real)piece[i].line, bend = (hyst_real)piece[i].bend;
            const double x = (double)(hyst_real)way[j];
            const double w = (double)line * x - (double)bend * expm1(-x);
            const double found = (double)hyst_coleman_way(line, bend, (hyst_real)w);
            /* What w and the two terms that make it round by, over the slope there. */
            const double slope = (double)line + (double)bend * exp(-x);
            const double parts = w + (double)line * x + fabs((double)bend) * -expm1(-x);
            CHECK_NEAR(found, x, 8.0 * (double)REAL_EPSILON * (x + parts / slope));
        }
    }
    CHECK_EQUAL(hyst_coleman_way(R(1.0), R(-0.5), R(0.0)), R(0.0));
}

int main(void)
{
    a_share_has_all_its_digits();
    the_way_leads_to_the_output();
    return check_result();
}
