/* The core with a power function of the firmware's own: everything that takes a power takes that. */
#include "check.h"
#include "own_power.h"

#ifndef HYST_POWER_HEADER
#error "build this, and the core it is linked to, with HYST_POWER_HEADER"
#endif

int own_powers_taken = 0;

/* x + x^3 / 2: f(2) = 6, f'(2) = 7. */
static const hyst_loading_curve cubic = {HYST_POWER_LAW, {{R(1.0), R(0.5), R(3.0)}}};

static void curves_take_it(void)
{
    own_powers_taken = 0;
    CHECK_EQUAL(hyst_loading(&cubic, R(2.0)), R(6.0));
    CHECK_EQUAL(hyst_loading_slope(&cubic, R(2.0)), R(7.0));
    CHECK(own_powers_taken == 2);
    CHECK_NEAR((double)hyst_unloading(&cubic, R(6.0)), 2.0, 4.0 * (double)REAL_EPSILON);
    CHECK(own_powers_taken > 2);
}

static void models_take_it(void)
{
    const hyst_masing model = {cubic, 0, 0, 4, R(0.0)};
    const hyst_real value[] = {R(1.0), R(0.5), R(2.0)};
    const hyst_memory_function square = {HYST_MEMORY_POWER, 3, NULL, value};
    hyst_real state[HYST_MASING_STACK + 8] = {R(0.0)};
    own_powers_taken = 0;
    CHECK_EQUAL(hyst_masing_step(&model, state, R(2.0)), R(6.0));
    /* Back by 2: 6 - 2 f(1) = 3. */
    CHECK_EQUAL(hyst_masing_step(&model, state, R(0.0)), R(3.0));
    CHECK(own_powers_taken == 2);
    CHECK_EQUAL(hyst_memory_value(&square, R(-4.0)), R(9.0));
    CHECK(own_powers_taken == 3);
}

int main(void)
{
    curves_take_it();
    models_take_it();
    return check_result();
}
