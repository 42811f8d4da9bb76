/* Where a stretch comes to what is sought: the first stretch, whose curve is known. */
#include "hyst/jiles_atherton.h"
#include "hyst/langevin.h"

#include "check.h"

static hyst_jiles_atherton magnet(void)
{
    const hyst_jiles_atherton model = {HYST_JILES_EFFECTIVE_FIELD, R(1.5), R(2.0), R(0.25), R(1.0), R(1.0),
                                       R(0.0), R(1.0), R(0.125), R(300.0), 0, R(0.0), R(0.0), 0};
    return model;
}

static hyst_real root_between(const hyst_jiles_stretch *on, hyst_real target, hyst_real low,
                              hyst_real high)
{
    hyst_real slope;
    const hyst_real at_low = hyst_jiles_sought(on, low, &slope);
    return hyst_jiles_root(on, target, low, at_low, high, hyst_jiles_sought(on, high, &slope));
}

static void it_finds_where_a_known_curve_was(void)
{
    const hyst_jiles_atherton model = magnet();
    const double place[] = {-40.0, -3.0, -0.2, 0.0, 1e-3, 0.9, 7.0, 90.0};
    for (size_t i = 0; i < COUNT(place); ++i) {
        const hyst_real x = (hyst_real)place[i];
        const hyst_jiles_stretch field = {&model, 1, R(1.0), R(0.1), R(0.0), R(0.0), R(1.0), R(-1.5),
                                          R(0.0), R(0.0), R(0.0)};
        const hyst_real target = x - R(1.5) * (R(0.25) * hyst_langevin(x) + R(0.1));
        const double found = (double)root_between(&field, target, R(-100.0), R(100.0));
        /* The slope is at least 1 - 1.5 / 12; both sides round a number of the size of x and 1. */
        CHECK_NEAR(found, (double)x, 4.0 * (double)REAL_EPSILON * (1.0 + fabs((double)x)));
    }
}

static void beyond_its_ends_it_gives_an_end(void)
{
    const hyst_jiles_atherton model = magnet();
    const hyst_jiles_stretch field = {&model, 1, R(1.0), R(0.0), R(0.0), R(0.0), R(1.0), R(-1.5),
                                          R(0.0), R(0.0), R(0.0)};
    CHECK_EQUAL(root_between(&field, R(-50.0), R(-1.0), R(2.0)), R(-1.0));
    CHECK_EQUAL(root_between(&field, R(50.0), R(-1.0), R(2.0)), R(2.0));
}

int main(void)
{
    it_finds_where_a_known_curve_was();
    beyond_its_ends_it_gives_an_end();
    return check_result();
}
