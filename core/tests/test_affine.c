#include "check.h"

/* By hand: 1.5 u - 0.25. */
static void follows_hand_calculation(void)
{
    const hyst_affine map = {R(1.5), R(-0.25)};
    CHECK_EQUAL(hyst_affine_step(&map, R(0.0)), R(-0.25));
    CHECK_EQUAL(hyst_affine_step(&map, R(3.0)), R(4.25));
    CHECK_EQUAL(hyst_affine_step(&map, R(-1.0)), R(-1.75));
}

static void row_asks_for_no_state(void)
{
    const hyst_affine map = {R(-2.0), R(0.5)};
    CHECK(hyst_affine_kind.length(&map) == 0);
    CHECK_EQUAL(hyst_affine_kind.step(&map, NULL, R(0.75)), R(-1.0));
}

int main(void)
{
    follows_hand_calculation();
    row_asks_for_no_state();
    return check_result();
}
