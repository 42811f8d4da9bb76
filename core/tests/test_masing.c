#include "check.h"

enum { depth = 40, samples = 3000, length = HYST_MASING_STACK + 2 * depth };

/* f(x) = x + x^2: y = y_i +- (d + d^2 / 2) on a branch, d = |u - u_i|. */
static hyst_masing quadratic(int inverse, int last_reversal, size_t reversals, double dead_band)
{
    hyst_masing model;
    model.curve.kind = HYST_POWER_LAW;
    model.curve.as.power_law.linear = R(1.0);
    model.curve.as.power_law.factor = R(1.0);
    model.curve.as.power_law.exponent = R(2.0);
    model.inverse = inverse;
    model.last_reversal = last_reversal;
    model.depth = reversals;
    model.dead_band = (hyst_real)dead_band;
    return model;
}

static void check_path(const hyst_masing *model, const double *u, const double *y, size_t count)
{
    hyst_real state[length] = {R(0.0)};
    for (size_t k = 0; k < count; ++k) {
        /* Numbers up to 20 with three operations each. */
        CHECK_NEAR((double)hyst_masing_step(model, state, (hyst_real)u[k]), y[k],
                   100.0 * (double)REAL_EPSILON);
    }
}

/* Rising to 3: 3 + 9 = 12. Down to 1: 12 - (2 + 2) = 8. Up to 2: 8 + 1.5 = 9.5. Down through 1,
 * which closes the small loop, to -1: 12 - (4 + 8) = 0. Up to 3 closes the large one: 12 again; on to
 * 4 along the loading curve: 20. To -4: -20, and on to -5: -30. */
static void nested_loops_close(void)
{
    const double u[] = {0.0, 1.0, 3.0, 1.0, 2.0, 1.0, -1.0, 3.0, 4.0, 0.0, -4.0, -5.0};
    const double y[] = {0.0, 2.0, 12.0, 8.0, 9.5, 8.0, 0.0, 12.0, 20.0, 8.0, -20.0, -30.0};
    const hyst_masing model = quadratic(0, 0, depth, 0.0);
    const hyst_masing inverse = quadratic(1, 0, depth, 0.0);
    check_path(&model, u, y, COUNT(u));
    check_path(&inverse, y, u, COUNT(u));
}

/* The same way to 2, then down: 9.5 - (1 + 0.5) = 8 at 1, and from there on still from the reversal
 * at 2: 9.5 - (3 + 4.5) = 2 at -1, where nested memory has 0. Up to 3: 2 + 4 + 8 = 14, not 12. */
static void the_last_reversal_alone_forgets(void)
{
    const double u[] = {0.0, 3.0, 1.0, 2.0, 1.0, -1.0, 3.0};
    const double y[] = {0.0, 12.0, 8.0, 9.5, 8.0, 2.0, 14.0};
    const hyst_masing model = quadratic(0, 1, 1, 0.0);
    const hyst_masing inverse = quadratic(1, 1, 1, 0.0);
    check_path(&model, u, y, COUNT(u));
    check_path(&inverse, y, u, COUNT(u));
}

/* Dead band 0.5: from 3 back to 2.6 along the loading curve, 2.6 + 6.76. Below 2.5, at which the new
 * branch starts with 2.5 + 6.25 = 8.75, to 1.5: 8.75 - (1 + 0.5). Back up by 0.2, along the branch:
 * 8.75 - (0.8 + 0.32). Up to 3: the branch starts at 1.5 + 0.5 = 2, with 8.75 - (0.5 + 0.125) = 8.125;
 * 8.125 + 1 + 0.5. */
static void a_dead_band_passes_over_small_reversals(void)
{
    const double u[] = {0.0, 3.0, 2.6, 1.5, 1.7, 3.0};
    const double y[] = {0.0, 12.0, 9.36, 7.25, 7.63, 9.625};
    const hyst_masing model = quadratic(0, 1, 1, 0.5);
    const hyst_masing inverse = quadratic(1, 1, 1, 0.5);
    check_path(&model, u, y, COUNT(u));
    check_path(&inverse, y, u, COUNT(u));
}

/* Room for two reversals, 4 and -2. The third, at 3, finds none: the input goes back down along the
 * branch it came by, reaches -2 with the output it had there and goes on as if nothing had been. */
static void a_full_stack_still_closes_every_loop(void)
{
    /* y(4) = 20; y(-2) = 20 - (6 + 18) = -4; on the branch up from -2: y(0) = -4 + 2 + 2 = 0,
     * y(3) = -4 + 5 + 12.5 = 13.5. Down from 4 again: y(-3) = 20 - (7 + 24.5) = -11.5. */
    const double u[] = {4.0, -2.0, 3.0, 0.0, 3.0, 0.0, -2.0, -3.0, 4.0, 5.0};
    const double y[] = {20.0, -4.0, 13.5, 0.0, 13.5, 0.0, -4.0, -11.5, 20.0, 30.0};
    const hyst_masing model = quadratic(0, 0, 2, 0.0);
    const hyst_masing inverse = quadratic(1, 0, 2, 0.0);
    hyst_real state[length] = {R(0.0)};
    check_path(&model, u, y, COUNT(u));
    check_path(&inverse, y, u, COUNT(u));
    for (size_t k = 0; k < 3; ++k) {
        hyst_masing_step(&model, state, (hyst_real)u[k]);
        CHECK_EQUAL(state[HYST_MASING_OVERFLOW], R(0.0));
    }
    hyst_masing_step(&model, state, R(0.0));
    CHECK_EQUAL(state[HYST_MASING_OVERFLOW], R(1.0));
    CHECK_EQUAL(state[HYST_MASING_COUNT], R(2.0));
}

static void inverse_gives_the_input_back(void)
{
    static hyst_real u[samples];
    const size_t depths[] = {depth, 3};
    fill_with_noise(u, samples, R(2.0));
    for (int last = 0; last <= 1; ++last) {
        for (size_t i = 0; i < 2; ++i) {
            const hyst_masing model = quadratic(0, last, last ? 1 : depths[i], last ? 0.1 * (double)i : 0.0);
            const hyst_masing inverse = quadratic(1, last, last ? 1 : depths[i], last ? 0.1 * (double)i : 0.0);
            hyst_real there[length] = {R(0.0)}, back[length] = {R(0.0)};
            for (size_t k = 0; k < samples; ++k) {
                const hyst_real y = hyst_masing_step(&model, there, u[k]);
                /* y stays below 20, a reversal adds a rounding of it, and 3000 reversals add up
                 * like a walk, 50 of them; the slope is at least 1 and the range 4. Nested memory
                 * does not add up. */
                CHECK_NEAR((double)hyst_masing_step(&inverse, back, y) / 4.0, (double)u[k] / 4.0,
                           (last ? 600.0 : 60.0) * (double)REAL_EPSILON);
            }
        }
    }
}

/* The loading curve of plays of width 1 and 2 with weights 1 and 2 beside 0.5. */
static void plays_are_the_piecewise_linear_case(void)
{
    const hyst_real p[] = {R(1.0), R(2.0)}, r[] = {R(1.0), R(2.0)};
    const hyst_real knot[] = {R(0.0), R(1.0), R(2.0)}, value[] = {R(0.0), R(0.5), R(2.0)};
    const hyst_real slope[] = {R(0.5), R(1.5), R(3.5)};
    const hyst_pi pi = {2, R(0.5), p, r};
    static hyst_real u[samples];
    hyst_real z[2] = {R(0.0), R(0.0)}, state[length] = {R(0.0)};
    hyst_masing model = quadratic(0, 0, depth, 0.0);
    model.curve.kind = HYST_PLAYS;
    model.curve.as.pieces.count = 3;
    model.curve.as.pieces.knot = knot;
    model.curve.as.pieces.value = value;
    model.curve.as.pieces.slope = slope;
    fill_with_noise(u, samples, R(6.0));
    for (size_t k = 0; k < samples; ++k) {
        /* Outputs up to 17, a few roundings each and no more than depth of them on each other. */
        CHECK_NEAR((double)hyst_masing_step(&model, state, u[k]), (double)hyst_pi_step(&pi, z, u[k]),
                   200.0 * (double)REAL_EPSILON);
    }
}

static void what_overflows_leaves_the_state_alone(void)
{
    for (int last = 0; last <= 1; ++last) {
        const hyst_masing model = quadratic(0, last, last ? 1 : depth, 0.0);
        hyst_real state[length] = {R(0.0)}, before[length];
        hyst_masing_step(&model, state, R(2.0));
        hyst_masing_step(&model, state, R(1.0));
        memcpy(before, state, sizeof before);
        CHECK(!hyst_is_finite(hyst_masing_step(&model, state, REAL_MAX)));
        CHECK(!hyst_is_finite(hyst_masing_step(&model, state, -REAL_MAX)));
        CHECK_SAME_BITS(state, before, length);
    }
}

static void a_damaged_count_reads_nothing_outside(void)
{
    const hyst_real counts[] = {R(1e9), R(-5.0), R(2.5)};
    for (size_t i = 0; i < COUNT(counts); ++i) {
        const hyst_masing model = quadratic(0, 0, 4, 0.0);
        hyst_real state[HYST_MASING_STACK + 8] = {R(0.0)};
        state[HYST_MASING_COUNT] = counts[i];
        CHECK(hyst_masing_reversals(&model, state) <= 4);
        CHECK(hyst_is_finite(hyst_masing_step(&model, state, R(1.0))));
        CHECK(hyst_is_finite(hyst_masing_step(&model, state, R(-1.0))));
    }
}

int main(void)
{
    nested_loops_close();
    the_last_reversal_alone_forgets();
    a_dead_band_passes_over_small_reversals();
    a_full_stack_still_closes_every_loop();
    inverse_gives_the_input_back();
    plays_are_the_piecewise_linear_case();
    what_overflows_leaves_the_state_alone();
    a_damaged_count_reads_nothing_outside();
    return check_result();
}
