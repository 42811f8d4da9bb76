#include "check.h"

static hyst_memory_element element(hyst_memory_kind kind, size_t count, const hyst_real *knot,
                                   const hyst_real *value)
{
    hyst_memory_element made;
    made.function.kind = kind;
    made.function.count = count;
    made.function.knot = knot;
    made.function.value = value;
    made.inverse = 0;
    made.absolute = 0;
    made.is_reset = 0;
    made.reset_to = R(0.0);
    made.dt = R(0.5);
    return made;
}

static void memory_functions_by_hand(void)
{
    const hyst_real power[] = {R(1.0), R(2.0), R(2.0)}; /* 1 + 2 p^2 */
    const hyst_real polynomial[] = {R(1.0), R(0.5), R(0.25)};
    const hyst_real knot[] = {R(-1.0), R(1.0), R(2.0)}, value[] = {R(3.0), R(1.0), R(5.0)};
    const hyst_memory_element by_power = element(HYST_MEMORY_POWER, 3, NULL, power);
    const hyst_memory_element by_polynomial = element(HYST_MEMORY_POLYNOMIAL, 3, NULL, polynomial);
    const hyst_memory_element by_table = element(HYST_MEMORY_TABLE, 3, knot, value);
    CHECK_EQUAL(hyst_memory_value(&by_power.function, R(0.0)), R(1.0));
    CHECK_NEAR((double)hyst_memory_value(&by_power.function, R(-3.0)), 19.0,
               200.0 * (double)REAL_EPSILON);
    CHECK_EQUAL(hyst_memory_value(&by_polynomial.function, R(-2.0)), R(1.0));
    CHECK_EQUAL(hyst_memory_value(&by_table.function, R(-7.0)), R(3.0));
    CHECK_EQUAL(hyst_memory_value(&by_table.function, R(0.0)), R(2.0));
    CHECK_EQUAL(hyst_memory_value(&by_table.function, R(1.5)), R(3.0));
    CHECK_EQUAL(hyst_memory_value(&by_table.function, R(9.0)), R(5.0));
}

/* M = 1 + p / 2 + p^2 / 4, dt = 0.5. p before each sample: 0, 1, 1 - 0.5, then 0.5 again. */
static void momentum_integrates_the_input(void)
{
    const hyst_real a[] = {R(1.0), R(0.5), R(0.25)};
    const hyst_real u[] = {R(2.0), R(-1.0), R(0.0), R(4.0)};
    const hyst_real y[] = {R(2.0), R(-1.75), R(0.0), R(5.25)};
    hyst_memory_element model = element(HYST_MEMORY_POLYNOMIAL, 3, NULL, a);
    hyst_memory_element inverse = model;
    hyst_real there[2] = {R(0.0), R(0.0)}, back[2] = {R(0.0), R(0.0)};
    inverse.inverse = 1;
    for (size_t k = 0; k < COUNT(u); ++k) {
        CHECK_EQUAL(hyst_memory_element_step(&model, there, u[k]), y[k]);
        CHECK_EQUAL(hyst_memory_element_step(&inverse, back, y[k]), u[k]);
    }
    CHECK_EQUAL(there[0], R(2.5));
    CHECK_SAME_BITS(there, back, 2);
}

/* With |u| and a reset to 2 where the sign changes, also over a zero: p before each sample is
 * 0, 1, 2 (reset), 2.5, 2.5, 2 (reset). M = p + 1. */
static void a_change_of_sign_sets_the_momentum_back(void)
{
    const hyst_real a[] = {R(1.0), R(1.0)};
    const hyst_real u[] = {R(2.0), R(2.0), R(-1.0), R(0.0), R(-2.0), R(4.0)};
    const hyst_real y[] = {R(2.0), R(4.0), R(-3.0), R(0.0), R(-7.0), R(12.0)};
    hyst_memory_element model = element(HYST_MEMORY_POLYNOMIAL, 2, NULL, a);
    hyst_memory_element inverse;
    hyst_real there[2] = {R(0.0), R(0.0)}, back[2] = {R(0.0), R(0.0)};
    model.absolute = 1;
    model.is_reset = 1;
    model.reset_to = R(2.0);
    inverse = model;
    inverse.inverse = 1;
    for (size_t k = 0; k < COUNT(u); ++k) {
        CHECK_EQUAL(hyst_memory_element_step(&model, there, u[k]), y[k]);
        CHECK_EQUAL(hyst_memory_element_step(&inverse, back, y[k]), u[k]);
    }
}

static void what_overflows_leaves_the_state_alone(void)
{
    const hyst_real a[] = {R(1.0), R(1.0)};
    const hyst_memory_element model = element(HYST_MEMORY_POLYNOMIAL, 2, NULL, a);
    hyst_real state[2] = {R(3.0), R(1.0)};
    const hyst_real before[2] = {R(3.0), R(1.0)};
    CHECK(!hyst_is_finite(hyst_memory_element_step(&model, state, REAL_MAX)));
    CHECK_SAME_BITS(state, before, 2);
}

int main(void)
{
    memory_functions_by_hand();
    momentum_integrates_the_input();
    a_change_of_sign_sets_the_momentum_back();
    what_overflows_leaves_the_state_alone();
    return check_result();
}
