#include "check.h"

/* Worked out by hand from z_k = max(u_k - r, min(u_k + r, z_{k-1})) with r = 1 and z = 0 before. */
static const hyst_real u_by_hand[] = {
    R(0.0), R(0.5), R(2.0), R(3.0), R(2.5), R(1.0), R(0.0), R(-1.0), R(-1.5), R(0.0), R(1.5)};
static const hyst_real z_by_hand[] = {
    R(0.0), R(0.0), R(1.0), R(2.0), R(2.0), R(2.0), R(1.0), R(0.0), R(-0.5), R(-0.5), R(0.5)};

static void play_follows_hand_calculation(void)
{
    hyst_real z = R(0.0);
    for (size_t k = 0; k < COUNT(u_by_hand); ++k) {
        CHECK_EQUAL(hyst_play_step(R(1.0), &z, u_by_hand[k]), z_by_hand[k]);
        CHECK_EQUAL(z, z_by_hand[k]);
    }
}

static void stop_is_input_less_play(void)
{
    hyst_real z = R(0.0);
    for (size_t k = 0; k < COUNT(u_by_hand); ++k) {
        CHECK_EQUAL(hyst_stop_step(R(1.0), &z, u_by_hand[k]), u_by_hand[k] - z_by_hand[k]);
        CHECK_EQUAL(z, z_by_hand[k]);
    }
}

/* At u - r == z and u + r == z the play touches without pushing. */
static void ties_do_not_push(void)
{
    hyst_real z = R(2.0);
    CHECK_EQUAL(hyst_play_step(R(1.0), &z, R(3.0)), R(2.0));
    CHECK_EQUAL(hyst_play_step(R(1.0), &z, R(1.0)), R(2.0));
    CHECK_EQUAL(hyst_play_step(R(1.0), &z, R(3.0)), R(2.0));
    CHECK_EQUAL(hyst_stop_step(R(1.0), &z, R(3.0)), R(1.0));
    CHECK_EQUAL(hyst_stop_step(R(1.0), &z, R(1.0)), R(-1.0));
}

static void threshold_zero_passes_the_input(void)
{
    hyst_real z = R(7.0);
    hyst_real w = R(7.0);
    for (size_t k = 0; k < COUNT(u_by_hand); ++k) {
        CHECK_EQUAL(hyst_play_step(R(0.0), &z, u_by_hand[k]), u_by_hand[k]);
        CHECK_EQUAL(hyst_stop_step(R(0.0), &w, u_by_hand[k]), R(0.0));
    }
}

static void plateau_changes_nothing(void)
{
    hyst_real z = R(0.0);
    hyst_play_step(R(0.25), &z, R(1.0));
    for (int k = 0; k < 3; ++k) {
        CHECK_EQUAL(hyst_play_step(R(0.25), &z, R(1.0)), R(0.75));
        CHECK_EQUAL(hyst_stop_step(R(0.25), &z, R(1.0)), R(0.25));
    }
}

static void wide_play_never_moves(void)
{
    hyst_real z = R(0.0);
    for (size_t k = 0; k < COUNT(u_by_hand); ++k) {
        CHECK_EQUAL(hyst_play_step(R(3.0), &z, u_by_hand[k]), R(0.0));
    }
    CHECK_EQUAL(hyst_play_step(REAL_MAX, &z, REAL_MAX), R(0.0));
    CHECK_EQUAL(hyst_play_step(REAL_MAX, &z, -REAL_MAX), R(0.0));
}

/* u - r and u + r may overflow; the state may not. */
static void state_stays_finite_at_the_end_of_the_number_line(void)
{
    hyst_real z = R(0.0);
    CHECK_EQUAL(hyst_play_step(R(1.0), &z, REAL_MAX), REAL_MAX);
    CHECK_EQUAL(hyst_play_step(REAL_MAX, &z, REAL_MAX), REAL_MAX);
    CHECK_EQUAL(hyst_play_step(REAL_MAX, &z, -REAL_MAX), R(0.0));
}

int main(void)
{
    play_follows_hand_calculation();
    stop_is_input_less_play();
    ties_do_not_push();
    threshold_zero_passes_the_input();
    plateau_changes_nothing();
    wide_play_never_moves();
    state_stays_finite_at_the_end_of_the_number_line();
    return check_result();
}
