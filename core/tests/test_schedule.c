/* Constants over a second signal against numbers by hand. */
#include "hyst/schedule.h"

#include "check.h"

static const hyst_real at[] = {R(-1.0), R(1.0), R(2.0)};
static const hyst_real row[] = {R(0.5), R(3.0), R(0.1), R(1.5), R(3.0), R(0.2), R(-0.5), R(3.0), R(0.7)};
static const hyst_schedule schedule = {3, 3, at, row};

static void follows_straight_lines(void)
{
    hyst_real c[3];
    CHECK(hyst_schedule_constants(&schedule, R(-0.5), c) == 0); /* a quarter of the way */
    CHECK_EQUAL(c[0], R(0.75));
    CHECK_EQUAL(c[1], R(3.0));
    CHECK(hyst_schedule_constants(&schedule, R(1.5), c) == 0); /* half way down */
    CHECK_EQUAL(c[0], R(0.5));
    CHECK_EQUAL(c[1], R(3.0));
}

static void knots_have_their_own_bits(void)
{
    hyst_real c[3];
    for (size_t k = 0; k < COUNT(at); ++k) {
        CHECK(hyst_schedule_constants(&schedule, at[k], c) == 0);
        CHECK_SAME_BITS(c, row + 3 * k, 3);
    }
}

static void is_held_outside_and_says_so(void)
{
    hyst_real c[3];
    CHECK(hyst_schedule_constants(&schedule, R(-1.5), c) == 1);
    CHECK_SAME_BITS(c, row, 3);
    CHECK(hyst_schedule_constants(&schedule, R(1e6), c) == 1);
    CHECK_SAME_BITS(c, row + 6, 3);
}

/* A weight of zero at one knot stays zero or more up to it, and one that is the same stays the same. */
static void stays_between_its_knots(void)
{
    static const hyst_real ends[] = {R(0.0), R(1.0)};
    static const hyst_real weights[] = {R(0.1), R(0.3), R(0.0), R(0.3)};
    const hyst_schedule falling = {2, 2, ends, weights};
    for (int k = 0; k < 10000; ++k) {
        hyst_real c[2];
        CHECK(hyst_schedule_constants(&falling, R(0.0001) * (hyst_real)k, c) == 0);
        CHECK(c[0] >= R(0.0) && c[0] <= R(0.1));
        CHECK_EQUAL(c[1], R(0.3));
    }
}

static void one_knot_and_what_is_no_number_give_constants(void)
{
    const hyst_schedule alone = {1, 3, at, row};
    hyst_real c[3] = {R(9.0), R(9.0), R(9.0)};
    CHECK(hyst_schedule_constants(&alone, R(0.0), c) == 1);
    CHECK_SAME_BITS(c, row, 3);
    CHECK(hyst_schedule_constants(&schedule, (hyst_real)NAN, c) == 0);
    CHECK_SAME_BITS(c, row, 3);
}

int main(void)
{
    follows_straight_lines();
    knots_have_their_own_bits();
    is_held_outside_and_says_so();
    stays_between_its_knots();
    one_knot_and_what_is_no_number_give_constants();
    return check_result();
}
