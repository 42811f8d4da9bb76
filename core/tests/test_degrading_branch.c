/* Branches of Bouc-Wen's model that degrades, against numbers by hand. */
#include "hyst/degrading_branch.h"

#include "check.h"

#define CLOSE (40.0 * (double)REAL_EPSILON + 1e-11)

static hyst_degrading plain(hyst_real n)
{
    const hyst_degrading model = {n,      R(0.5), R(0.0), R(0.0), R(0.0),
                                  R(0.0), R(0.0), R(1.0), R(0.0), R(1.0)};
    return model;
}

static hyst_degrading_point along(const hyst_degrading *model, hyst_degrading_point at, hyst_real way)
{
    for (;;) {
        hyst_degrading_point next;
        const hyst_real step = hyst_degrading_next(model, at, &next);
        if (step >= way) {
            return hyst_degrading_advance(model, at, way);
        }
        at = next;
        way = way - step;
    }
}

/* n = 1 out by 1: v = 1 - 1/e, e = 1 - v; n = 2: v = tanh 1, e = ln cosh 1. */
static void a_new_loop_is_the_closed_form(void)
{
    const hyst_degrading_point rest = {R(0.0), R(0.0)};
    const hyst_degrading one = plain(R(1.0)), two = plain(R(2.0));
    CHECK_NEAR((double)along(&one, rest, R(1.0)).share, 0.6321205588285577, CLOSE);
    CHECK_NEAR((double)along(&one, rest, R(1.0)).energy, 0.36787944117144233, CLOSE);
    CHECK_NEAR((double)along(&two, rest, R(1.0)).share, 0.7615941559557649, CLOSE);
    CHECK_NEAR((double)along(&two, rest, R(1.0)).energy, 0.4337808304830271, CLOSE);
}

/* Unloading from -v, n = 1, ratio 1/2: dv = (1 + |v| / 2) dway reaches 0 after 2 ln(1 + |v| / 2), where
 * the branch has a node, and goes on by 1 - exp(-way). */
static void the_way_to_zero_is_a_node(void)
{
    const hyst_degrading model = plain(R(1.0));
    hyst_degrading_point at = {R(-0.5), R(0.0)};
    hyst_real way = R(0.0);
    while (at.share < R(0.0)) {
        hyst_degrading_point next;
        way = way + hyst_degrading_next(&model, at, &next);
        at = next;
    }
    CHECK_EQUAL(at.share, R(0.0));
    CHECK_NEAR((double)way, 0.44628710262841953, CLOSE);
    at.share = R(-0.5);
    CHECK_NEAR((double)along(&model, at, R(1.44628710262841953)).share, 0.6321205588285577, CLOSE);
}

/* v = 1/2, nu = 1 + e, eta = 1 + 2 e at e = 1: (1 - 2/2) / 3 = 0; at v = 1/4 it is (1 - 1/2) / 3. */
static void slopes_by_hand(void)
{
    hyst_degrading model = plain(R(1.0));
    model.delta_nu = R(1.0);
    model.delta_eta = R(2.0);
    const hyst_degrading_point held = {R(0.5), R(1.0)}, free_ = {R(0.25), R(1.0)};
    CHECK_EQUAL(hyst_degrading_slope(&model, held).share, R(0.0));
    CHECK_NEAR((double)hyst_degrading_slope(&model, free_).share, 0.5 / 3.0, CLOSE);
    CHECK_EQUAL(hyst_degrading_slope(&model, free_).energy, R(0.25));
    /* Pinched: zeta1 = (1 - 1/e) / 2 of e = p = 1 at its middle v = q nu^-1 = 1/4. */
    model.zeta = R(0.5);
    model.p = R(1.0);
    model.q = R(0.5);
    CHECK_NEAR((double)hyst_degrading_slope(&model, free_).share,
               0.5 / 3.0 * (1.0 - 0.5 * 0.6321205588285577), CLOSE);
}

int main(void)
{
    a_new_loop_is_the_closed_form();
    the_way_to_zero_is_a_node();
    slopes_by_hand();
    return check_result();
}
