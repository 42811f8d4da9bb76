/* Pieces of branches of a Preisach model against numbers by hand. */
#include "two_by_two.h"

#define CLOSE (4.0 * (double)REAL_EPSILON)

static hyst_preisach_piece to(const hyst_preisach *model, hyst_real u_start, hyst_real y_start,
                              hyst_real u)
{
    const hyst_preisach_point start = {u_start, y_start};
    return hyst_preisach_to_input(model, &start, u);
}

/* Down from saturation: the triangle at first, 2 (1 - u)^2, then half a triangle and a rectangle. */
static void a_falling_branch_is_a_line_and_a_square(void)
{
    const hyst_preisach model = two_by_two(R(0.0), 0);
    const hyst_preisach_piece first = to(&model, R(1.0), R(4.0), R(0.5));
    const hyst_preisach_piece second = to(&model, R(1.0), R(4.0), R(-0.5));
    CHECK_EQUAL(first.line, R(0.0));
    CHECK_EQUAL(first.square, R(2.0));
    CHECK_EQUAL(hyst_preisach_output(&first, R(0.5)), R(3.5));
    CHECK_EQUAL(second.from.u, R(0.0));
    CHECK_EQUAL(second.from.y, R(2.0));
    CHECK_EQUAL(second.line, R(4.0));
    CHECK_EQUAL(second.square, R(2.0));
    CHECK_EQUAL(hyst_preisach_output(&second, R(-0.5)), R(-0.5));
    CHECK_EQUAL(second.to.y, R(-4.0));
}

/* Up from -1/2, y = -1/2: a quarter of the triangle below 0, then half the rectangle and a triangle. */
static void a_branch_inside_a_cell_has_the_share_that_lies_ahead(void)
{
    const hyst_preisach model = two_by_two(R(0.0), 0);
    const hyst_preisach_piece first = to(&model, R(-0.5), R(-0.5), R(-0.25));
    const hyst_preisach_piece second = to(&model, R(-0.5), R(-0.5), R(0.5));
    CHECK_EQUAL(hyst_preisach_output(&first, R(-0.25)), R(-0.375));
    CHECK_EQUAL(first.to.y, R(0.0));
    CHECK_EQUAL(hyst_preisach_output(&second, R(0.5)), R(1.5));
    CHECK_EQUAL(second.to.y, R(4.0));
}

/* The linear part lies beside the relays, inside the grid and beyond. */
static void beyond_the_grid_the_relays_rest(void)
{
    const hyst_preisach model = two_by_two(R(0.5), 0);
    const hyst_preisach_piece before = to(&model, R(-3.0), R(-5.5), R(-2.0));
    const hyst_preisach_piece inside = to(&model, R(-3.0), R(-5.5), R(1.0));
    const hyst_preisach_piece beyond = to(&model, R(-3.0), R(-5.5), R(5.0));
    const hyst_preisach_piece late = to(&model, R(2.0), R(5.0), R(5.0));
    CHECK_EQUAL(hyst_preisach_output(&before, R(-2.0)), R(-5.0));
    CHECK_EQUAL(hyst_preisach_output(&inside, R(1.0)), R(4.5));
    CHECK_EQUAL(hyst_preisach_output(&beyond, R(5.0)), R(6.5));
    CHECK_EQUAL(hyst_preisach_output(&late, R(5.0)), R(6.5));
    CHECK_EQUAL(hyst_preisach_output(&late, R(2.0)), R(5.0));
}

/* Ridges: the cell (1, 0) turns from as far in as the branch began in its own, here three quarters. */
static void ridges_bend_where_the_branch_began(void)
{
    hyst_preisach model = two_by_two(R(0.0), 0);
    model.ridges = 1;
    const hyst_preisach_piece own = to(&model, R(-0.25), R(-1.0), R(0.0));
    const hyst_preisach_piece first = to(&model, R(-0.25), R(-1.0), R(0.5));
    const hyst_preisach_piece second = to(&model, R(-0.25), R(-1.0), R(0.875));
    CHECK_EQUAL(hyst_preisach_output(&own, R(0.0)), R(-0.5));
    CHECK_EQUAL(hyst_preisach_output(&first, R(0.5)), R(0.5));
    CHECK_EQUAL(hyst_preisach_output(&second, R(0.875)), R(1.75));
    CHECK_EQUAL(second.to.y, R(2.5));
}

static void the_first_loading_curve_is_a_table(void)
{
    const hyst_preisach model = two_by_two(R(0.5), 0);
    const hyst_real u[] = {R(0.0), R(0.5), R(-0.5), R(1.0), R(-3.0)};
    const hyst_real y[] = {R(0.0), R(1.25), R(-1.25), R(4.5), R(-5.5)};
    for (size_t i = 0; i < COUNT(u); ++i) {
        const hyst_preisach_piece there = hyst_preisach_to_input(&model, NULL, u[i]);
        const hyst_preisach_piece back = hyst_preisach_to_output(&model, NULL, y[i]);
        CHECK_EQUAL(hyst_preisach_output(&there, u[i]), y[i]);
        CHECK_NEAR((double)hyst_preisach_input(&back, y[i]), (double)u[i], CLOSE);
    }
}

static void outputs_lead_back_to_inputs(void)
{
    const hyst_preisach_point start = {R(-0.75), R(-2.0)};
    for (int ridges = 0; ridges < 2; ++ridges) {
        hyst_preisach model = two_by_two(R(0.5), 0);
        model.ridges = ridges;
        for (int k = -48; k < 32; ++k) {
            const hyst_real u = (hyst_real)k / R(16.0);
            const hyst_preisach_piece there = hyst_preisach_to_input(&model, &start, u);
            const hyst_real y = hyst_preisach_output(&there, u);
            const hyst_preisach_piece back = hyst_preisach_to_output(&model, &start, y);
            /* A slope of 1/2 at least makes an output's rounding, 8 epsilon, twice that. */
            CHECK_NEAR((double)hyst_preisach_input(&back, y), (double)u, 8.0 * CLOSE);
        }
    }
}

/* More than saturation has no input: the answer is not finite. */
static void saturation_is_the_end_without_a_linear_part(void)
{
    const hyst_preisach model = two_by_two(R(0.0), 0);
    const hyst_preisach_point start = {R(-1.0), R(-4.0)};
    const hyst_preisach_piece at = hyst_preisach_to_output(&model, &start, R(4.0));
    const hyst_preisach_piece beyond = hyst_preisach_to_output(&model, &start, R(4.5));
    const hyst_real answer = hyst_preisach_input(&beyond, R(4.5));
    CHECK_EQUAL(hyst_preisach_input(&at, R(4.0)), R(1.0));
    CHECK(!(answer - answer <= R(0.0)));
    /* Rounding of the sums before it is none: two epsilon of 4 are, 32 are not. */
    const hyst_real near = R(4.0) + R(8.0) * (hyst_real)REAL_EPSILON;
    const hyst_real off = R(4.0) + R(128.0) * (hyst_real)REAL_EPSILON;
    const hyst_preisach_piece full = hyst_preisach_to_output(&model, &start, near);
    const hyst_real too_far = hyst_preisach_input(&full, off);
    CHECK_EQUAL(hyst_preisach_input(&full, near), R(1.0));
    CHECK(!(too_far - too_far <= R(0.0)));
}

static void roots_are_right_to_an_epsilon(void)
{
    for (int k = 1; k <= 800; ++k) {
        const hyst_real x = (hyst_real)k / R(100.0);
        CHECK_NEAR((double)(hyst_root(x) / (hyst_real)sqrt((double)x)), 1.0,
                   1.5 * (double)REAL_EPSILON);
        const hyst_real small = x * R(1e-27);
        CHECK_NEAR((double)(hyst_root(small) / (hyst_real)sqrt((double)small)), 1.0,
                   1.5 * (double)REAL_EPSILON);
    }
    CHECK_EQUAL(hyst_root(R(0.0)), R(0.0));
    CHECK_EQUAL(hyst_root(R(4.0)), R(2.0));
}

int main(void)
{
    a_falling_branch_is_a_line_and_a_square();
    a_branch_inside_a_cell_has_the_share_that_lies_ahead();
    beyond_the_grid_the_relays_rest();
    ridges_bend_where_the_branch_began();
    the_first_loading_curve_is_a_table();
    outputs_lead_back_to_inputs();
    saturation_is_the_end_without_a_linear_part();
    roots_are_right_to_an_epsilon();
    return check_result();
}
