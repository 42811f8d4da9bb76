/* Stages inside a stage: a play and a gain by hand. */
#include "hyst/affine.h"
#include "hyst/play.h"
#include "hyst/state_map.h"

#include "check.h"

/* z = 2 play_1[u] + 1,  y = u + u z + z^2. */
static const hyst_real radius = R(1.0);
static const hyst_affine gain = {R(2.0), R(1.0)};
static const hyst_real coefficient[] = {R(0.0), R(0.0), R(1.0), R(1.0), R(1.0), R(0.0)};

static void stages_make_z_and_the_map_sees_u_too(void)
{
    const hyst_stage inside[] = {{&hyst_play_kind, &radius}, {&hyst_affine_kind, &gain}};
    const hyst_state_map map = {{2, inside}, {2, coefficient}};
    hyst_real state[1] = {R(0.0)};
    CHECK(hyst_state_map_kind.length(&map) == 1u);
    /* play 2, z 5 */
    CHECK_EQUAL(hyst_state_map_kind.step(&map, state, R(3.0)), R(43.0));
    /* play rests at 2, z 5 */
    CHECK_EQUAL(hyst_state_map_kind.step(&map, state, R(1.0)), R(31.0));
    /* play 0, z 1 */
    CHECK_EQUAL(hyst_state_map_kind.step(&map, state, R(-1.0)), R(-1.0));
    CHECK_EQUAL(state[0], R(0.0));
}

static void without_stages_z_is_the_input(void)
{
    const hyst_state_map map = {{0, NULL}, {2, coefficient}};
    CHECK(hyst_state_map_kind.length(&map) == 0u);
    CHECK_EQUAL(hyst_state_map_kind.step(&map, NULL, R(3.0)), R(21.0));
}

/* What overflows between two stages goes no further than that. */
static void an_overflow_inside_leaves_the_stages_behind_it(void)
{
    const hyst_affine huge = {REAL_MAX, R(0.0)};
    const hyst_stage inside[] = {{&hyst_affine_kind, &huge}, {&hyst_play_kind, &radius}};
    const hyst_state_map map = {{2, inside}, {2, coefficient}};
    hyst_real state[1] = {R(0.25)};
    CHECK(!hyst_is_finite(hyst_state_map_kind.step(&map, state, R(4.0))));
    CHECK_EQUAL(state[0], R(0.25));
}

int main(void)
{
    stages_make_z_and_the_map_sees_u_too();
    without_stages_z_is_the_input();
    an_overflow_inside_leaves_the_stages_behind_it();
    return check_result();
}
