/* The Preisach operator, its memory and its inverse, against numbers by hand. */
#include "two_by_two.h"

static void a_loop_by_hand(void)
{
    const hyst_preisach model = two_by_two(R(0.0), 0);
    const hyst_real u[] = {R(0.5), R(1.0), R(0.5), R(0.0), R(-0.5), R(0.5), R(-0.5), R(-2.0), R(2.0)};
    const hyst_real y[] = {R(1.0),  R(4.0),  R(3.5),  R(2.0), R(-0.5),
                           R(1.5),  R(-0.5), R(-4.0), R(4.0)};
    hyst_real state[LENGTH] = {R(0.0)};
    for (size_t i = 0; i < COUNT(u); ++i) {
        CHECK_EQUAL(hyst_preisach_step(&model, state, u[i]), y[i]);
    }
}

static void a_closed_loop_leaves_no_trace(void)
{
    const hyst_preisach model = two_by_two(R(0.25), 0);
    const hyst_real inner[] = {R(-0.25), R(0.25), R(0.0), R(0.5), R(-0.125), R(0.75)};
    hyst_real plain[LENGTH] = {R(0.0)}, looped[LENGTH] = {R(0.0)};
    hyst_preisach_step(&model, plain, R(-0.75));
    hyst_preisach_step(&model, plain, R(0.75));
    hyst_preisach_step(&model, looped, R(-0.75));
    hyst_preisach_step(&model, looped, R(0.75));
    for (size_t i = 0; i < COUNT(inner); ++i) {
        hyst_preisach_step(&model, looped, inner[i]);
    }
    CHECK_SAME_BITS(looped, plain, LENGTH);
    CHECK_EQUAL(plain[HYST_PREISACH_COUNT], R(0.0)); /* and 0.75 is the mirror image of -0.75 */
}

static void a_closed_loop_takes_two_reversals_with_it(void)
{
    const hyst_preisach model = two_by_two(R(0.25), 0);
    const hyst_real u[] = {R(0.9), R(-0.5), R(0.5), R(-0.2)};
    hyst_real plain[LENGTH] = {R(0.0)}, looped[LENGTH] = {R(0.0)};
    for (size_t i = 0; i < COUNT(u); ++i) {
        if (i < 3u) {
            hyst_preisach_step(&model, plain, u[i]);
        }
        hyst_preisach_step(&model, looped, u[i]);
    }
    hyst_preisach_step(&model, looped, R(0.5));
    CHECK_EQUAL(plain[HYST_PREISACH_COUNT], R(2.0));
    CHECK_SAME_BITS(looped, plain, LENGTH);
}

/* Left at 1/2 by the first loading curve, y_v = 1; back to 1/4 a sixteenth of the triangle turns. */
static void a_start_on_the_first_loading_curve_may_turn_at_once(void)
{
    const hyst_preisach model = two_by_two(R(0.0), 0), inverse = two_by_two(R(0.0), 1);
    hyst_real there[LENGTH] = {R(0.0)}, home[LENGTH] = {R(0.0)};
    there[HYST_PREISACH_INPUT] = R(0.5);
    home[HYST_PREISACH_INPUT] = R(1.0);
    home[HYST_PREISACH_OUTPUT] = R(0.5);
    CHECK_EQUAL(hyst_preisach_step(&model, there, R(0.25)), R(0.875));
    CHECK_EQUAL(hyst_preisach_step(&inverse, home, R(0.875)), R(0.25));
}

static void samples_in_between_and_rests_change_nothing(void)
{
    const hyst_preisach model = two_by_two(R(0.25), 0);
    hyst_real once[LENGTH] = {R(0.0)}, often[LENGTH] = {R(0.0)};
    hyst_preisach_step(&model, once, R(0.9));
    hyst_preisach_step(&model, once, R(-0.3));
    for (int k = 1; k <= 90; ++k) {
        hyst_preisach_step(&model, often, (hyst_real)k / R(100.0));
        hyst_preisach_step(&model, often, (hyst_real)k / R(100.0));
    }
    often[HYST_PREISACH_INPUT] = once[HYST_PREISACH_STACK]; /* 90 / 100 is not 0.9 in every precision */
    hyst_preisach_step(&model, often, R(0.9));
    for (int k = 89; k >= -29; --k) {
        hyst_preisach_step(&model, often, (hyst_real)k / R(100.0));
    }
    hyst_preisach_step(&model, often, R(-0.3));
    CHECK_SAME_BITS(often, once, LENGTH);
}

/* Five reversals in room for four: the loop nested deepest is traced without area, and closes. */
static void a_full_stack_still_closes_loops(void)
{
    const hyst_preisach model = two_by_two(R(0.0), 0);
    const hyst_real u[] = {R(0.9), R(-0.8), R(0.7), R(-0.6), R(0.5)};
    hyst_real state[LENGTH] = {R(0.0)}, y[COUNT(u)];
    for (size_t i = 0; i < COUNT(u); ++i) {
        y[i] = hyst_preisach_step(&model, state, u[i]);
    }
    CHECK_EQUAL(state[HYST_PREISACH_COUNT], R(4.0));
    CHECK_EQUAL(state[HYST_PREISACH_OVERFLOW], R(0.0));
    const hyst_real there = hyst_preisach_step(&model, state, R(0.25));
    CHECK_EQUAL(state[HYST_PREISACH_OVERFLOW], R(1.0));
    CHECK_EQUAL(hyst_preisach_step(&model, state, R(0.5)), y[4]);
    CHECK_EQUAL(hyst_preisach_step(&model, state, R(0.25)), there);
    CHECK_EQUAL(hyst_preisach_step(&model, state, R(-0.6)), y[3]);
    CHECK_EQUAL(hyst_preisach_step(&model, state, R(0.7)), y[2]);
    CHECK_EQUAL(hyst_preisach_step(&model, state, R(-0.8)), y[1]);
}

static void the_inverse_undoes_it(void)
{
    const hyst_preisach model = two_by_two(R(0.5), 0), inverse = two_by_two(R(0.5), 1);
    const hyst_real u[] = {R(0.0), R(0.5),  R(-0.25), R(0.25), R(0.25), R(-0.125),
                           R(2.0), R(-3.0), R(-1.0),  R(0.0),  R(-0.5), R(1.0)};
    hyst_real there[LENGTH] = {R(0.0)}, home[LENGTH] = {R(0.0)};
    for (size_t i = 0; i < COUNT(u); ++i) {
        const hyst_real y = hyst_preisach_step(&model, there, u[i]);
        /* Sizes up to 5 over a slope of 1/2, a few roundings. */
        CHECK_NEAR((double)hyst_preisach_step(&inverse, home, y), (double)u[i],
                   40.0 * (double)REAL_EPSILON);
    }
}

static void beyond_saturation_the_inverse_keeps_its_state(void)
{
    const hyst_preisach inverse = two_by_two(R(0.0), 1);
    hyst_real state[LENGTH] = {R(0.0)}, before[LENGTH];
    hyst_preisach_step(&inverse, state, R(1.0));
    hyst_preisach_step(&inverse, state, R(0.75));
    memcpy(before, state, sizeof state);
    const hyst_real answer = hyst_preisach_step(&inverse, state, R(4.5));
    CHECK(!(answer - answer <= R(0.0)));
    CHECK_SAME_BITS(state, before, LENGTH);
    CHECK_EQUAL(hyst_preisach_step(&inverse, state, R(4.0)), R(1.0));
    CHECK_EQUAL(hyst_preisach_step(&inverse, state, R(-4.0)), R(-1.0));
}

/* A state of nonsense counts no more reversals than there is room for. */
static void a_damaged_count_is_bounded(void)
{
    const hyst_preisach model = two_by_two(R(0.0), 0);
    hyst_real state[LENGTH] = {R(0.0)};
    state[HYST_PREISACH_COUNT] = R(1e9);
    CHECK(hyst_preisach_reversals(&model, state) == DEPTH);
    state[HYST_PREISACH_COUNT] = R(-3.0);
    CHECK(hyst_preisach_reversals(&model, state) == 0u);
}

int main(void)
{
    a_loop_by_hand();
    a_closed_loop_leaves_no_trace();
    a_closed_loop_takes_two_reversals_with_it();
    a_start_on_the_first_loading_curve_may_turn_at_once();
    samples_in_between_and_rests_change_nothing();
    a_full_stack_still_closes_loops();
    the_inverse_undoes_it();
    beyond_saturation_the_inverse_keeps_its_state();
    a_damaged_count_is_bounded();
    return check_result();
}
