#include "check.h"

static const hyst_real limit[] = {R(1.0), R(1.0), R(1.0), R(1.0), R(1.0), R(1.0)};

static hyst_joint two_plays(void)
{
    const hyst_joint joint = {2, {0, 0, NULL, R(0.0), R(0.0)}, {0, 0, NULL, R(0.0), R(0.0)}, R(0.5),
                              R(4.0), R(3.0), R(0.0), R(100.0), R(1e-9), R(0.0), R(100.0), limit};
    return joint;
}

/* Sums 0.25 -> 0.5, then 0.5 - 0.25 -> 0.5, then 5 -> 4; radii 2 1 -> 1.5 1.5. */
static void clamps_sums_and_orders_radii(void)
{
    const hyst_joint joint = two_plays();
    hyst_real theta[] = {R(0.25), R(-0.25), R(4.5), R(2.0), R(1.0), R(-7.0)};
    const hyst_real expected[] = {R(0.5), R(0.0), R(3.5), R(1.5), R(1.5), R(-7.0)};
    hyst_joint_clamp(&joint, theta);
    CHECK_SAME_BITS(theta, expected, COUNT(expected));
}

static void leaves_what_can_be_inverted(void)
{
    const hyst_joint joint = two_plays();
    hyst_real theta[] = {R(0.7), R(-0.1), R(0.3), R(0.1), R(2.9), R(1.0)};
    hyst_real before[COUNT(theta)];
    memcpy(before, theta, sizeof before);
    hyst_joint_clamp(&joint, theta);
    CHECK_SAME_BITS(theta, before, COUNT(before));
}

/* Terms at 0, 1 and -2: slopes w_0, w_0 + w_1, w_0 + w_2 in [0.5, 4]. */
static void clamps_both_sides_of_a_map(void)
{
    const hyst_real knee[] = {R(0.0), R(1.0), R(-2.0)};
    const hyst_joint_map map = {3, 1, knee, R(0.5), R(4.0)};
    hyst_joint joint = two_plays();
    hyst_real theta[] = {R(1.0), R(0.0), R(0.0), R(1.0), R(2.0), R(0.0), R(1.0), R(-1.0), R(5.0)};
    joint.back = map;
    hyst_joint_clamp(&joint, theta);
    CHECK_EQUAL(theta[7], R(-0.5));
    CHECK_EQUAL(theta[8], R(3.0));
}

/* Radii 2 and 1 with variances 1 and 3: the step r_2 - r_1 = -1 must become 0, and the less certain
 * radius moves three times as far. */
static void moves_what_is_less_certain(void)
{
    const hyst_joint joint = two_plays();
    const hyst_joint_layout at = hyst_joint_places(&joint);
    hyst_real values[2 * 6 + 15] = {R(0.0)};
    hyst_real a[6];
    hyst_real product[6];
    const hyst_real theta[] = {R(1.0), R(0.5), R(0.5), R(2.0), R(1.0), R(0.0)};
    memcpy(values, theta, sizeof theta);
    values[6 + 3] = R(1.0);
    values[6 + 4] = R(3.0);
    hyst_joint_project(&joint, &at, values, a, product);
    CHECK_EQUAL(values[3], R(1.75));
    CHECK_EQUAL(values[4], R(1.75));
    CHECK_EQUAL(values[1], R(0.5));
}

int main(void)
{
    clamps_sums_and_orders_radii();
    leaves_what_can_be_inverted();
    clamps_both_sides_of_a_map();
    moves_what_is_less_certain();
    return check_result();
}
