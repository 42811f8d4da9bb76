/* One Gauss-Newton step on a plan, against steps by hand. */
#include "hyst/rate_preview.h"

#include "check.h"

/* No plays: the output is 2 u, the guess y / 2. */
static hyst_rate_preview a_line(size_t preview)
{
    const hyst_rate_dependent_pi plays = {{0, R(2.0), NULL, NULL}, R(1.0), 0, NULL, {0, NULL, NULL}};
    const hyst_rate_dependent_pi guess = {{0, R(0.5), NULL, NULL}, R(2.0), 0, NULL, {0, NULL, NULL}};
    const hyst_rate_preview model = {plays, guess, preview, 0, R(0.0), R(0.0), 0, R(0.0)};
    return model;
}

/* Two commands, targets 2 and 6, the last one to end at 3: errors 2 u_0 - 2, 2 u_1 - 6 and the end's
 * 2 (u_1 - 3). From 0 the step arrives but for its damping: u = (1, 3) / (1 + damping share). */
static void a_quadratic_is_solved_at_once(void)
{
    const hyst_rate_preview model = a_line(1);
    const hyst_preview_places at = hyst_preview_layout(&model);
    const hyst_preview_stage stage = {R(1.0), R(0.01), R(0.01), R(2.0)};
    hyst_real state[64] = {R(0.0)};
    hyst_real damping = R(1.0);
    hyst_real *plan = state + at.plan;
    state[at.target] = R(2.0);
    state[at.target + 1u] = R(6.0);
    state[at.start + 1u] = R(3.0);
    /* 4 u_0 + 4 u_0 damping = 4; (4 + 4) u_1 + 4 u_1 damping = 24. */
    const hyst_real cost = hyst_preview_improve(&model, &at, state, 2, &stage, plan, &damping);
    CHECK_NEAR((double)plan[0], 0.5, 4.0 * (double)REAL_EPSILON);
    CHECK_NEAR((double)plan[1], 2.0, 8.0 * (double)REAL_EPSILON);
    /* (1 - 2)^2 + (4 - 6)^2 + 4 (2 - 3)^2 */
    CHECK_NEAR((double)cost, 9.0, 64.0 * (double)REAL_EPSILON);
    CHECK_NEAR((double)damping, 0.3, (double)REAL_EPSILON);
}

/* At the optimum nothing is gained, and the damping grows. */
static void nothing_is_made_worse(void)
{
    const hyst_rate_preview model = a_line(1);
    const hyst_preview_places at = hyst_preview_layout(&model);
    const hyst_preview_stage stage = {R(1.0), R(0.01), R(0.01), R(2.0)};
    hyst_real state[64] = {R(0.0)};
    hyst_real damping = R(1.0);
    hyst_real *plan = state + at.plan;
    state[at.target] = R(2.0);
    state[at.target + 1u] = R(6.0);
    state[at.start + 1u] = R(3.0);
    plan[0] = R(1.0);
    plan[1] = R(3.0);
    CHECK_EQUAL(hyst_preview_improve(&model, &at, state, 2, &stage, plan, &damping), R(0.0));
    CHECK_EQUAL(plan[0], R(1.0));
    CHECK_EQUAL(plan[1], R(3.0));
    CHECK_EQUAL(damping, R(4.0));
}

static const hyst_real weight[] = {R(0.5)};
static const hyst_real radius[] = {R(1.0)};

/* A play that is carried by the first command and rests at the other two, u = 3, 2.5, 2.25, z = 2: y =
 * u / 2 + 1. Its derivatives stay with the command that moved it, so without roughness, of targets that
 * are 0.5 higher throughout, the command that moved it does all of that: one half step 1/2 of u_0 is
 * z + 1/2, y_0 + 1/2, and y_1, y_2 + 1/4 each; the least squares are solved by hand below. */
static void a_play_at_rest_depends_on_what_moved_it(void)
{
    const hyst_rate_dependent_pi plays = {{1, R(0.5), weight, radius}, R(0.0), 0, NULL, {0, NULL, NULL}};
    const hyst_rate_preview model = {plays, plays, 2, 0, R(0.0), R(0.0), 0, R(0.0)};
    const hyst_preview_places at = hyst_preview_layout(&model);
    const hyst_preview_stage stage = {R(0.0), R(0.001), R(0.001), R(1.0)};
    hyst_real state[128] = {R(0.0)};
    hyst_real damping = R(0.0001);
    hyst_real *plan = state + at.plan;
    const hyst_real u[] = {R(3.0), R(2.5), R(2.25)};
    const hyst_real wanted[] = {R(2.75), R(2.5), R(2.375)};
    for (size_t k = 0; k < 3u; ++k) {
        plan[k] = u[k];
        state[at.target + k] = wanted[k];
    }
    state[at.start + 2u] = R(2.25);
    (void)hyst_preview_improve(&model, &at, state, 3, &stage, plan, &damping);
    /* Unknowns a, b, c: a = 1/4, a/2 + b/2 = 1/4, a/2 + c/2 = 1/4 and c = 0; normal equations of
     * (a - 1/4)^2 + (a/2 + b/2 - 1/4)^2 + (a/2 + c/2 - 1/4)^2 + c^2:  b = 1/2 - a; then
     * a - 1/4 + (a + c - 1/2) / 4 = 0 and (a + c - 1/2) / 4 + c = 0: a = 2/7 + .., as solved here:
     * 5a + c = 3/2, a + 5c = 1/2: a = 7/24, c = 1/24, b = 5/24. */
    CHECK_NEAR((double)plan[0], 3.0 + 7.0 / 24.0, 1e-3);
    CHECK_NEAR((double)plan[1], 2.5 + 5.0 / 24.0, 1e-3);
    CHECK_NEAR((double)plan[2], 2.25 + 1.0 / 24.0, 1e-3);
}

int main(void)
{
    a_quadratic_is_solved_at_once();
    nothing_is_made_worse();
    a_play_at_rest_depends_on_what_moved_it();
    return check_result();
}
