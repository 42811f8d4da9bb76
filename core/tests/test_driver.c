/* Codes and volts of a driver against numbers by hand and against every code in turn. */
#include "hyst/driver.h"

#include "check.h"

#define WHOLE INT32_MIN
#define LAST INT32_MAX

/* Steps of 1/4 and 1/2 volt: every volt is exact. */
static const int32_t rising_code[] = {-4, 0, 4};
static const hyst_real rising_volt[] = {R(-1.0), R(0.0), R(2.0)};
static const hyst_real rising_slope[] = {R(0.25), R(0.5)};

static hyst_driver rising(void)
{
    const hyst_driver driver = {3, rising_code, rising_volt, rising_slope, -4, 4};
    return driver;
}

static void volts_are_lines_between_the_points(void)
{
    const hyst_driver driver = rising();
    CHECK_EQUAL(hyst_driver_volt(&driver, -4), R(-1.0));
    CHECK_EQUAL(hyst_driver_volt(&driver, -1), R(-0.25));
    CHECK_EQUAL(hyst_driver_volt(&driver, 0), R(0.0));
    CHECK_EQUAL(hyst_driver_volt(&driver, 3), R(1.5));
    CHECK_EQUAL(hyst_driver_volt(&driver, 4), R(2.0));
    CHECK_EQUAL(hyst_driver_volt(&driver, LAST), R(2.0));
    CHECK_EQUAL(hyst_driver_volt(&driver, WHOLE), R(-1.0));
}

static void ties_go_to_the_lower_code(void)
{
    const hyst_driver driver = rising();
    CHECK(hyst_driver_code(&driver, R(-0.875)) == -4);
    CHECK(hyst_driver_code(&driver, R(-0.75)) == -3);
    CHECK(hyst_driver_code(&driver, R(0.25)) == 0);
    CHECK(hyst_driver_code(&driver, R(0.375)) == 1);
    CHECK(hyst_driver_code(&driver, R(1.75)) == 3);
    CHECK(hyst_driver_code(&driver, R(1.875)) == 4);
}

static void a_falling_table_ties_to_the_lower_code_too(void)
{
    const int32_t code[] = {0, 8};
    const hyst_real volt[] = {R(2.0), R(0.0)}, slope[] = {R(-0.25)};
    const hyst_driver driver = {2, code, volt, slope, 0, 8};
    CHECK_EQUAL(hyst_driver_volt(&driver, 3), R(1.25));
    CHECK(hyst_driver_code(&driver, R(1.25)) == 3);
    CHECK(hyst_driver_code(&driver, R(1.125)) == 3);
    CHECK(hyst_driver_code(&driver, R(1.0625)) == 4);
    CHECK(hyst_driver_code(&driver, R(9.0)) == 0);
    CHECK(hyst_driver_code(&driver, R(-9.0)) == 8);
}

static void codes_stay_among_those_that_may_be_given(void)
{
    hyst_driver driver = rising();
    driver.lowest = -2;
    driver.highest = 2;
    CHECK(hyst_driver_code(&driver, R(-0.9)) == -2);
    CHECK(hyst_driver_code(&driver, R(1.9)) == 2);
    CHECK(hyst_driver_code(&driver, R(0.5)) == 1);
    driver.highest = -1;
    CHECK(hyst_driver_code(&driver, R(1.9)) == -1);
    driver.lowest = 3;
    driver.highest = 4;
    CHECK(hyst_driver_code(&driver, R(-0.9)) == 3);
}

static void what_is_not_finite_gives_a_code_that_may_be_given(void)
{
    const hyst_driver driver = rising();
    const hyst_real infinity = (hyst_real)INFINITY;
    int32_t code;
    CHECK(hyst_driver_code(&driver, infinity) == 4);
    CHECK(hyst_driver_code(&driver, -infinity) == -4);
    CHECK(hyst_driver_code(&driver, REAL_MAX) == 4);
    code = hyst_driver_code(&driver, (hyst_real)NAN);
    CHECK(code >= -4 && code <= 4);
}

/* All codes that 32 bits hold, in steps of 1024 V / 2^32 in double; in single they cannot be told apart
 * by volts, so there the steps are 256 times as many codes. */
static void the_whole_range_of_32_bits(void)
{
    const int32_t code[] = {WHOLE, LAST};
    const hyst_real step = R(1024.0) / R(4294967296.0);
    const hyst_real volt[] = {R(-512.0), R(512.0) - step}, slope[] = {step};
    const hyst_driver driver = {2, code, volt, slope, WHOLE, LAST};
    CHECK_EQUAL(hyst_driver_volt(&driver, WHOLE), R(-512.0));
    CHECK_EQUAL(hyst_driver_volt(&driver, 0), R(0.0));
    CHECK_EQUAL(hyst_driver_volt(&driver, LAST), R(512.0) - step);
    CHECK(hyst_driver_code(&driver, R(600.0)) == LAST);
    CHECK(hyst_driver_code(&driver, R(-600.0)) == WHOLE);
#ifndef HYST_SINGLE
    CHECK(hyst_driver_code(&driver, R(0.0)) == 0);
    CHECK(hyst_driver_code(&driver, R(0.6) * step) == 1);
    CHECK(hyst_driver_code(&driver, R(-256.0)) == -1073741824);
#endif
}

/* A measured table, whose slopes are rounded: every code comes back from its own volts, and between two
 * codes the nearest is found as it is by looking at all of them. */
static void every_code_is_found_again(void)
{
    static const int32_t code[] = {-2048, -700, -699, 1000, 2047};
    static const hyst_real volt[] = {R(-10.03), R(-3.41), R(-3.404), R(4.87), R(9.99)};
    hyst_real slope[4];
    hyst_driver driver = {5, code, volt, slope, -2048, 2047};
    size_t lost = 0u, other = 0u, sinks = 0u;
    for (size_t i = 0; i < COUNT(slope); ++i) {
        slope[i] = (volt[i + 1u] - volt[i]) / (hyst_real)(code[i + 1u] - code[i]);
    }
    for (int32_t c = -2048; c <= 2047; ++c) {
        const hyst_real own = hyst_driver_volt(&driver, c);
        lost += hyst_driver_code(&driver, own) != c ? 1u : 0u;
        sinks += c > -2048 && hyst_driver_volt(&driver, c - 1) >= own ? 1u : 0u;
    }
    for (int k = 0; k < 500; ++k) {
        const hyst_real wanted = R(-10.5) + R(0.0421) * (hyst_real)k;
        int32_t nearest = -2048;
        for (int32_t c = -2047; c <= 2047; ++c) {
            const hyst_real here = hyst_driver_volt(&driver, c) - wanted;
            const hyst_real there = hyst_driver_volt(&driver, nearest) - wanted;
            const hyst_real a = here < R(0.0) ? -here : here, b = there < R(0.0) ? -there : there;
            nearest = a < b ? c : nearest;
        }
        other += hyst_driver_code(&driver, wanted) != nearest ? 1u : 0u;
    }
    CHECK(lost == 0u);
    CHECK(sinks == 0u);
    CHECK(other == 0u);
}

int main(void)
{
    volts_are_lines_between_the_points();
    ties_go_to_the_lower_code();
    a_falling_table_ties_to_the_lower_code_too();
    codes_stay_among_those_that_may_be_given();
    what_is_not_finite_gives_a_code_that_may_be_given();
    the_whole_range_of_32_bits();
    every_code_is_found_again();
    return check_result();
}
