/* The step of a preview: what it holds, what it refuses, what it leaves of its state. */
#include "hyst/rate_preview.h"

#include "check.h"

#define PREVIEW 4u
#define PLAYS 2u

static const hyst_real p[] = {R(0.5), R(0.25)};
static const hyst_real r[] = {R(1.0), R(2.0)};
/* S4 eqs. 14-15 by hand: slopes 1/2, 1, 5/4; g = 1/c_j - 1/c_{j-1}, s = 1/2, 1/2 + 1. */
static const hyst_real g[] = {R(-1.0), R(-0.2)};
static const hyst_real s[] = {R(0.5), R(1.5)};

static hyst_rate_preview two_plays(hyst_real growth)
{
    const hyst_rate_dependent_pi plays = {{PLAYS, R(0.5), p, r}, growth, 0, p, {0, p, p}};
    const hyst_rate_dependent_pi guess = {{PLAYS, R(2.0), g, s}, R(0.5) * growth, 0, p, {0, p, p}};
    const hyst_rate_preview model = {plays, guess, PREVIEW, 0, R(0.0), R(0.0), 0, R(0.0)};
    return model;
}

#define LENGTH (2u * (PLAYS + 2u) + HYST_PREVIEW_SCALARS + 4u * 5u + 2u * 10u + 4u * 5u + 15u)

/* 1 from virgin plays: u = 2 - 1 (1 - 1/2) = 3/2; z = 1/2, 0: 3/4 + 1/4 = 1. */
static void a_reference_at_rest_is_held_from_the_first_sample(void)
{
    const hyst_rate_preview model = two_plays(R(3.0));
    hyst_real state[LENGTH] = {R(0.0)};
    CHECK(hyst_rate_preview_kind.length(&model) == LENGTH);
    for (size_t k = 0; k < 20u; ++k) {
        CHECK_EQUAL(hyst_rate_preview_step(&model, state, R(1.0)), R(1.5));
    }
    CHECK_EQUAL(state[0], R(0.5));
    CHECK_EQUAL(state[1], R(0.0));
    CHECK_EQUAL(state[2], R(1.5));
}

/* A ramp long after its beginning: all plays follow, y = (c - S growth) u_k + S growth u_{k-1} - sum
 * p r with c = 5/4, S = 3/4, so at slope d a sample y = c u - S growth d - 1. */
static void a_ramp_is_followed_as_late_as_said(void)
{
    const hyst_rate_preview model = two_plays(R(3.0));
    hyst_real state[LENGTH] = {R(0.0)};
    hyst_real u = R(0.0);
    for (size_t k = 0; k < 101u; ++k) {
        u = hyst_rate_preview_step(&model, state, R(0.5) * (hyst_real)k);
    }
    /* y = 0.5 (100 - 4) = 48 and u rises by 0.4: u = (48 + 0.75 * 3 * 0.4 + 1) / 1.25. The plan's end
     * is that of the explicit inverse, which shows in some digits. */
    CHECK_NEAR((double)u, (48.0 + 0.9 + 1.0) / 1.25, 0.02);
}

static void scratch_is_left_empty(void)
{
    const hyst_rate_preview model = two_plays(R(3.0));
    const hyst_preview_places at = hyst_preview_layout(&model);
    hyst_real state[LENGTH] = {R(0.0)};
    for (size_t k = 0; k < 30u; ++k) {
        (void)hyst_rate_preview_step(&model, state, (hyst_real)((k * k) % 7u));
        for (size_t i = at.scratch; i < at.end; ++i) {
            CHECK_EQUAL(state[i], R(0.0));
        }
    }
}

static void limits_hold_to_the_bit(void)
{
    hyst_rate_preview model = two_plays(R(3.0));
    hyst_real state[LENGTH] = {R(0.0)};
    hyst_real last = R(0.0);
    model.ranged = 1;
    model.low = R(-1.0);
    model.high = R(2.0);
    model.slowed = 1;
    model.change = R(0.25);
    for (size_t k = 0; k < 60u; ++k) {
        const hyst_real u = hyst_rate_preview_step(&model, state, (hyst_real)((k * 5u) % 11u) - R(4.0));
        CHECK(u >= R(-1.0) && u <= R(2.0));
        CHECK(k == 0u || (u - last <= R(0.25) && last - u <= R(0.25)));
        last = u;
    }
}

static void what_overflows_is_answered_and_not_kept(void)
{
    const hyst_rate_preview model = two_plays(R(3.0));
    hyst_real state[LENGTH] = {R(0.0)};
    hyst_real before[LENGTH];
    for (size_t k = 0; k < 9u; ++k) {
        (void)hyst_rate_preview_step(&model, state, (hyst_real)k);
    }
    for (size_t i = 0; i < LENGTH; ++i) {
        before[i] = state[i];
    }
    const hyst_real y = hyst_rate_preview_step(&model, state, REAL_MAX);
    CHECK(!(y - y == R(0.0)));
    CHECK_SAME_BITS(state, before, LENGTH);
}

/* What squares beyond all numbers is not improved, and still followed by what the explicit inverse says. */
static void large_numbers_stay_numbers(void)
{
    const hyst_rate_preview model = two_plays(R(3.0));
    hyst_real state[LENGTH] = {R(0.0)};
    for (size_t k = 0; k < 40u; ++k) {
        const hyst_real y = (k % 3u) == 0u ? REAL_MAX / R(64.0) : -REAL_MAX / R(64.0);
        const hyst_real u = hyst_rate_preview_step(&model, state, y);
        CHECK(u - u == R(0.0));
    }
}

int main(void)
{
    a_reference_at_rest_is_held_from_the_first_sample();
    a_ramp_is_followed_as_late_as_said();
    scratch_is_left_empty();
    limits_hold_to_the_bit();
    what_overflows_is_answered_and_not_kept();
    large_numbers_stay_numbers();
    return check_result();
}
