/* Inverses that solve for every sample: numbers by hand, and round trips with memories of any kind. */
#include "hyst/solved.h"

#include "hyst/affine.h"
#include "hyst/play.h"

#include "check.h"

static uint32_t seed = 1u;

/* Between -1 and 1, whole multiples of 1/2048. */
static hyst_real drawn(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (hyst_real)((int32_t)(seed >> 20) - 2048) * R(0.00048828125);
}

/* y = u + play / 2 with r = 1/4: at z = 0 it rests up to u = 1/4, then y = 3/2 u - 1/8. */
static void solves_plays_by_hand(void)
{
    const hyst_real p[] = {R(0.5)}, r[] = {R(0.25)};
    const hyst_pi pi = {1, R(1.0), p, r};
    hyst_real z[] = {R(0.0)};
    CHECK_EQUAL(hyst_pi_solved_step(&pi, z, R(0.125)), R(0.125));
    CHECK_EQUAL(z[0], R(0.0));
    CHECK_EQUAL(hyst_pi_solved_step(&pi, z, R(1.375)), R(1.0));
    CHECK_EQUAL(z[0], R(0.75));
    CHECK_EQUAL(hyst_pi_solved_step(&pi, z, R(-1.375)), R(-1.0));
    CHECK_EQUAL(z[0], R(-0.75));
}

/* Weights of zero or more, radii and memory that change at random between samples: whatever the memory,
 * the input comes back and the memory is that of the model. */
static void plays_come_back_while_constants_move(void)
{
    enum { plays = 7 };
    hyst_real p[plays], r[plays], there[plays] = {R(0.0)}, home[plays] = {R(0.0)};
    for (size_t k = 0; k < 20000u; ++k) {
        hyst_pi pi = {plays, R(0.5) + R(0.25) * drawn(), p, r};
        for (size_t i = 0; i < plays; ++i) {
            p[i] = R(0.5) + R(0.5) * drawn();
            r[i] = R(0.5) + R(0.5) * drawn();
        }
        const hyst_real u = R(2.0) * drawn();
        const hyst_real y = hyst_pi_step(&pi, there, u);
        CHECK_NEAR((double)hyst_pi_solved_step(&pi, home, y), (double)u, 64.0 * (double)REAL_EPSILON);
        for (size_t i = 0; i < plays; ++i) {
            CHECK_NEAR((double)home[i], (double)there[i], 64.0 * (double)REAL_EPSILON);
            home[i] = there[i];
        }
    }
}

static void maps_come_back_rising_or_falling(void)
{
    enum { terms = 6 };
    hyst_real weight[terms], threshold[terms];
    const hyst_dead_zone map = {terms, weight, threshold};
    for (size_t k = 0; k < 20000u; ++k) {
        const hyst_real sign = k % 2u == 0u ? R(1.0) : -R(1.0);
        for (size_t i = 0; i < terms; ++i) {
            weight[i] = sign * (i == 0u ? R(1.5) : R(0.25) * drawn());
            threshold[i] = i == 0u ? R(0.0) : drawn();
        }
        const hyst_real u = R(2.0) * drawn();
        const hyst_real y = hyst_dead_zone_step(&map, u);
        CHECK_NEAR((double)hyst_dead_zone_solved_step(&map, y), (double)u, 128.0 * (double)REAL_EPSILON);
    }
}

static void lines_come_back(void)
{
    const hyst_affine map = {R(-2.0), R(0.5)};
    CHECK_EQUAL(hyst_affine_solved_step(&map, R(4.5)), -R(2.0));
}

/* What overflows is no answer, and the memory stays. */
static void what_overflows_is_not_finite_and_not_kept(void)
{
    const hyst_real p[] = {R(0.0)}, r[] = {R(0.25)};
    const hyst_pi pi = {1, R(0.25), p, r};
    hyst_real z[] = {R(0.5)};
    const hyst_real u = hyst_pi_solved_step(&pi, z, REAL_MAX);
    CHECK(!(u - u == R(0.0)));
    CHECK_EQUAL(z[0], R(0.5));
}

int main(void)
{
    solves_plays_by_hand();
    plays_come_back_while_constants_move();
    maps_come_back_rising_or_falling();
    lines_come_back();
    what_overflows_is_not_finite_and_not_kept();
    return check_result();
}
