/* Where a branch comes to what is sought. */
#include "hyst/degrading_branch.h"

#include "check.h"

#define CLOSE (40.0 * (double)REAL_EPSILON + 1e-11)

static const hyst_degrading model = {R(1.0), R(0.5), R(0.0), R(0.0), R(0.0),
                                     R(0.0), R(0.0), R(1.0), R(0.0), R(1.0)};

/* 1 - exp(-x) is 1/16 at x = ln(16/15); beside 3 x, 1 - exp(-x) + 3 x of x = 1/8 comes back. */
static void ways_by_hand(void)
{
    const hyst_degrading_point rest = {R(0.0), R(0.0)};
    CHECK_NEAR((double)hyst_degrading_root(&model, rest, R(0.0), R(0.0625), R(0.25)),
               0.06453852113757118, CLOSE);
    CHECK_NEAR((double)hyst_degrading_root(&model, rest, R(3.0), R(0.49250309741540454), R(0.25)),
               0.125, CLOSE);
}

static void it_keeps_to_its_ends(void)
{
    const hyst_degrading_point at = {R(0.25), R(0.0)};
    CHECK_EQUAL(hyst_degrading_root(&model, at, R(1.0), R(0.25), R(0.125)), R(0.0));
    CHECK_EQUAL(hyst_degrading_root(&model, at, R(1.0), R(0.2), R(0.125)), R(0.0));
    CHECK_EQUAL(hyst_degrading_root(&model, at, R(1.0), R(9.0), R(0.125)), R(0.125));
}

int main(void)
{
    ways_by_hand();
    it_keeps_to_its_ends();
    return check_result();
}
