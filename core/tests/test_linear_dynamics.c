/* Linear dynamics against the difference equation worked out by hand, and the two realizations
 * against each other. Most constants are powers of two, so nothing is rounded. */
#include "check.h"

/* (0.5 q^-1 + 0.25 q^-2) / (1 - 0.5 q^-1): h = 0, 0.5, 0.5, 0.25, 0.125, ... */
static const hyst_real a[] = {R(0.5), R(1.0), R(0.0), R(0.0)}; /* columns: x1' = x1/2 + u, x2' = x1 */
static const hyst_real b[] = {R(1.0), R(0.0)};
static const hyst_real c[] = {R(0.5), R(0.25)};
static const hyst_real impulse[] = {R(0.0), R(0.5), R(0.5), R(0.25), R(0.125)};

static void test_impulse_response(void)
{
    const hyst_state_space system = {2, 0, a, b, c, R(0.0)};
    const hyst_real coefficient[] = {R(0.0), R(0.5), R(0.25), R(-0.5), R(0.0)};
    const hyst_sections sections = {1, coefficient};
    hyst_real x[2] = {0}, s[2] = {0};
    for (size_t k = 0; k < COUNT(impulse); ++k) {
        const hyst_real u = k == 0 ? R(1.0) : R(0.0);
        CHECK_EQUAL(hyst_state_space_step(&system, x, u), impulse[k]);
        CHECK_EQUAL(hyst_sections_step(&sections, s, u), impulse[k]);
    }
}

static void test_delay_and_feedthrough(void)
{
    const hyst_state_space system = {2, 3, a, b, c, R(2.0)};
    const hyst_real expected[] = {R(0.0), R(0.0), R(0.0), R(2.0), R(0.5), R(0.5), R(0.25)};
    hyst_real state[5] = {0};
    for (size_t k = 0; k < COUNT(expected); ++k) {
        const hyst_real u = k == 0 ? R(1.0) : R(0.0);
        CHECK_EQUAL(hyst_state_space_step(&system, state, u), expected[k]);
    }
}

static void test_order_zero_is_a_gain(void)
{
    const hyst_state_space gain = {0, 0, NULL, NULL, NULL, R(-2.0)};
    hyst_real none[1] = {R(7.0)};
    CHECK_EQUAL(hyst_state_space_step(&gain, none, R(1.5)), R(-3.0));
    CHECK_EQUAL(none[0], R(7.0));
}

static void test_sections_follow_one_another(void)
{
    /* (1 + q^-1)(1 - q^-1) = 1 - q^-2 */
    const hyst_real coefficient[] = {R(1.0), R(1.0),  R(0.0), R(0.0), R(0.0),
                                     R(1.0), R(-1.0), R(0.0), R(0.0), R(0.0)};
    const hyst_sections sections = {2, coefficient};
    const hyst_real expected[] = {R(1.0), R(0.0), R(-1.0), R(0.0)};
    hyst_real state[4] = {0};
    for (size_t k = 0; k < COUNT(expected); ++k) {
        const hyst_real u = k == 0 ? R(1.0) : R(0.0);
        CHECK_EQUAL(hyst_sections_step(&sections, state, u), expected[k]);
    }
}

static void test_overflow_leaves_the_state(void)
{
    const hyst_real growing[] = {R(2.0)}, one[] = {R(1.0)};
    const hyst_real pole[] = {R(1.0), R(0.0), R(0.0), R(-2.0), R(0.0)};
    const hyst_stage stages[] = {
        {&hyst_state_space_kind, &(const hyst_state_space){1, 1, growing, one, one, R(0.0)}},
        {&hyst_sections_kind, &(const hyst_sections){1, pole}}};
    const hyst_real start[2][2] = {{REAL_MAX, R(1.0)}, {REAL_MAX, R(0.0)}};
    for (size_t i = 0; i < COUNT(stages); ++i) {
        const hyst_chain chain = {1, &stages[i]};
        hyst_real state[2] = {start[i][0], start[i][1]};
        hyst_guard guard = {R(5.0), 0};
        CHECK_EQUAL(hyst_guarded_step(&chain, state, &guard, R(1.0)), R(5.0));
        CHECK(guard.fault);
        CHECK_SAME_BITS(state, start[i], 2);
    }
}

static void test_chain_runs_a_record(void)
{
    const hyst_real coefficient[] = {R(0.25), R(0.5), R(0.125), R(-0.5), R(0.25)};
    const hyst_stage stages[] = {
        {&hyst_state_space_kind, &(const hyst_state_space){2, 2, a, b, c, R(0.5)}},
        {&hyst_sections_kind, &(const hyst_sections){1, coefficient}}};
    const hyst_chain chain = {COUNT(stages), stages};
    hyst_real u[100], y[100], stepped[100], at_once[6] = {0}, by_step[6] = {0};
    CHECK(hyst_chain_state_length(&chain) == 6);
    fill_with_noise(u, COUNT(u), R(3.0));
    hyst_chain_run(&chain, at_once, u, y, 40);
    hyst_chain_run(&chain, at_once, u + 40, y + 40, 60);
    for (size_t k = 0; k < COUNT(u); ++k) {
        stepped[k] = hyst_chain_step(&chain, by_step, u[k]);
    }
    CHECK_SAME_BITS(y, stepped, COUNT(y));
    CHECK_SAME_BITS(at_once, by_step, COUNT(at_once));
}

int main(void)
{
    test_impulse_response();
    test_delay_and_feedthrough();
    test_order_zero_is_a_gain();
    test_sections_follow_one_another();
    test_overflow_leaves_the_state();
    test_chain_runs_a_record();
    return check_result();
}
