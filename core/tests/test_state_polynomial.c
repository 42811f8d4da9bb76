/* The polynomial of input and state against numbers by hand. */
#include "hyst/state_polynomial.h"

#include "check.h"

/* 1 + 2 z + 4 z^2 + 8 u + 16 u z + 32 u^2, every number exact. */
static void terms_stand_in_their_order(void)
{
    const hyst_real c[] = {R(1.0), R(2.0), R(4.0), R(8.0), R(16.0), R(32.0)};
    const hyst_state_polynomial map = {2, c};
    CHECK_EQUAL(hyst_state_polynomial_value(&map, R(0.0), R(0.0)), R(1.0));
    CHECK_EQUAL(hyst_state_polynomial_value(&map, R(0.0), R(-0.5)), R(1.0));
    CHECK_EQUAL(hyst_state_polynomial_value(&map, R(2.0), R(0.0)), R(145.0));
    CHECK_EQUAL(hyst_state_polynomial_value(&map, R(2.0), R(-0.5)), R(129.0));
}

static void degree_one_is_a_plane_and_degree_zero_a_constant(void)
{
    const hyst_real c[] = {R(3.0), R(-2.0), R(0.5)};
    const hyst_state_polynomial plane = {1, c}, constant = {0, c};
    CHECK_EQUAL(hyst_state_polynomial_value(&plane, R(4.0), R(1.5)), R(2.0));
    CHECK_EQUAL(hyst_state_polynomial_value(&constant, R(4.0), R(1.5)), R(3.0));
}

/* u z^2 alone, of degree 3: place 4 + 2. */
static void a_mixed_term_of_a_higher_degree(void)
{
    hyst_real c[10] = {R(0.0)};
    const hyst_state_polynomial map = {3, c};
    c[6] = R(2.0);
    CHECK_EQUAL(hyst_state_polynomial_value(&map, R(-3.0), R(1.5)), R(-13.5));
}

int main(void)
{
    terms_stand_in_their_order();
    degree_one_is_a_plane_and_degree_zero_a_constant();
    a_mixed_term_of_a_higher_degree();
    return check_result();
}
