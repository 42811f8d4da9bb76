/* Limits of a drive against numbers by hand. */
#include "check.h"

static void test_limits(void)
{
    const hyst_drive_limits limits = {R(-2.0), R(3.0), R(0.0)};
    const hyst_real u[] = {R(0.0), R(5.0), R(-2.5), R(-2.0), R(3.0)};
    const hyst_real expected[] = {R(0.0), R(3.0), R(-2.0), R(-2.0), R(3.0)};
    hyst_real last = R(100.0); /* counts for nothing without a rate */
    for (size_t k = 0; k < COUNT(u); ++k) {
        CHECK_EQUAL(hyst_limited_drive(&limits, &last, u[k]), expected[k]);
        CHECK_EQUAL(last, expected[k]);
    }
}

static void test_rate(void)
{
    const hyst_drive_limits limits = {R(-1.0), R(3.0), R(0.5)};
    const hyst_real u[] = {R(0.25), R(5.0), R(5.0), R(-9.0), R(-9.0), R(-9.0), R(-9.0), R(-0.75)};
    const hyst_real expected[] = {R(0.25), R(0.75), R(1.25),  R(0.75),
                                  R(0.25), R(-0.25), R(-0.75), R(-0.75)};
    hyst_real last = R(0.0);
    for (size_t k = 0; k < COUNT(u); ++k) {
        CHECK_EQUAL(hyst_limited_drive(&limits, &last, u[k]), expected[k]);
    }
    CHECK_EQUAL(hyst_limited_drive(&limits, &last, R(-9.0)), R(-1.0)); /* the limit is nearer */
}

/* A last drive from elsewhere: the limits hold, whatever the rate. */
static void test_limits_hold_whatever_was_before(void)
{
    const hyst_drive_limits limits = {R(-1.0), R(1.0), R(0.5)};
    hyst_real last = R(100.0);
    CHECK_EQUAL(hyst_limited_drive(&limits, &last, R(0.0)), R(1.0));
    last = -REAL_MAX;
    CHECK_EQUAL(hyst_limited_drive(&limits, &last, R(0.0)), R(-1.0));
}

static void test_a_rate_without_limits(void)
{
    const hyst_drive_limits limits = {-REAL_MAX, REAL_MAX, R(2.0)};
    hyst_real last = R(0.0);
    CHECK_EQUAL(hyst_limited_drive(&limits, &last, REAL_MAX), R(2.0));
    last = REAL_MAX;
    CHECK_EQUAL(hyst_limited_drive(&limits, &last, REAL_MAX), REAL_MAX);
}

int main(void)
{
    test_limits();
    test_rate();
    test_limits_hold_whatever_was_before();
    test_a_rate_without_limits();
    return check_result();
}
