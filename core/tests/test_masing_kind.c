#include "check.h"

/* The row is the step and the state length of masing.h: f(x) = x + x^2, a rise to 2 gives 6 and, on
 * the branch back to 0, 6 - 2 f(1) = 2. */
static void row_is_the_model_s_own(void)
{
    const hyst_masing model = {{HYST_POWER_LAW, {{R(1.0), R(1.0), R(2.0)}}}, 0, 0, 3, R(0.0)};
    hyst_real state[HYST_MASING_STACK + 6] = {R(0.0)};
    CHECK(hyst_masing_kind.length(&model) == HYST_MASING_STACK + 6);
    CHECK_NEAR((double)hyst_masing_kind.step(&model, state, R(2.0)), 6.0, 40.0 * (double)REAL_EPSILON);
    CHECK_NEAR((double)hyst_masing_kind.step(&model, state, R(0.0)), 2.0, 40.0 * (double)REAL_EPSILON);
    CHECK_EQUAL(state[HYST_MASING_COUNT], R(1.0));
}

int main(void)
{
    row_is_the_model_s_own();
    return check_result();
}
