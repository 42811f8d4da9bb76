/* The linear part of the tracking controller against the difference equation worked out by hand. Most
 * constants are powers of two, so nothing is rounded. */
#include "check.h"

static void test_inputs_and_columns_are_not_mixed_up(void)
{
    /* x1' = y_ref, x2' = x1 + 4 y, v = x2: v_k = y_ref_{k-2} + 4 y_{k-1}. */
    const hyst_real a[] = {R(0.0), R(1.0), R(0.0), R(0.0)};
    const hyst_real b[] = {R(1.0), R(0.0), R(0.0), R(4.0)};
    const hyst_real c[] = {R(0.0), R(1.0)};
    const hyst_tracking_controller controller = {2, a, b, c, {R(0.0), R(0.0)}, {0, NULL}};
    hyst_real state[2] = {0}, y_ref[50], y[50];
    fill_with_noise(y_ref, COUNT(y_ref), R(1.0));
    fill_with_noise(y, COUNT(y), R(0.125));
    for (size_t k = 0; k < COUNT(y); ++k) {
        const hyst_real expected =
            (k < 2 ? R(0.0) : y_ref[k - 2]) + R(4.0) * (k < 1 ? R(0.0) : y[k - 1]);
        CHECK_EQUAL(hyst_tracking_controller_linear(&controller, state, y_ref[k], y[k]), expected);
    }
}

static void test_state_stays_where_something_is_not_finite(void)
{
    const hyst_real a[] = {R(2.0)}, b[] = {R(1.0), R(0.0)}, c[] = {R(1.0)};
    const hyst_tracking_controller controller = {1, a, b, c, {R(0.0), R(1.0)}, {0, NULL}};
    hyst_real state[1] = {REAL_MAX};
    /* v = x + y is finite, the next x = 2 x + y_ref is not; then the other way round. */
    CHECK(!hyst_is_finite(hyst_tracking_controller_linear(&controller, state, R(0.0), R(0.0))));
    CHECK_EQUAL(state[0], REAL_MAX);
    state[0] = REAL_MAX / R(4.0);
    CHECK(!hyst_is_finite(hyst_tracking_controller_linear(&controller, state, R(0.0), REAL_MAX)));
    CHECK_EQUAL(state[0], REAL_MAX / R(4.0));
}

static void test_takes_back_all_or_nothing(void)
{
    const hyst_real w[] = {R(0.5), R(-2.0)};
    hyst_real x[] = {R(1.0), R(3.0)};
    hyst_tracking_take_back(2, w, x, R(4.0));
    CHECK_EQUAL(x[0], R(3.0));
    CHECK_EQUAL(x[1], R(-5.0));
    hyst_tracking_take_back(2, w, x, REAL_MAX); /* x[1] would overflow */
    CHECK_EQUAL(x[0], R(3.0));
    CHECK_EQUAL(x[1], R(-5.0));
    hyst_tracking_take_back(0, NULL, NULL, R(1.0));
}

int main(void)
{
    test_inputs_and_columns_are_not_mixed_up();
    test_state_stays_where_something_is_not_finite();
    test_takes_back_all_or_nothing();
    return check_result();
}
