/* Branches by sub-steps against solutions by hand. */
#include "hyst/branch.h"

#include "check.h"

/* dz = (1 - s z) du: w = 1 - s z falls by exp(-|du|). L = 1. */
static hyst_real relaxing(const void *model, hyst_real u, hyst_real z, hyst_real sign)
{
    (void)model;
    (void)u;
    return R(1.0) - sign * z;
}

/* dz = (1 - z^2) du, from 0: tanh u. L = 2. */
static hyst_real bounded(const void *model, hyst_real u, hyst_real z, hyst_real sign)
{
    (void)model;
    (void)u;
    (void)sign;
    return R(1.0) - z * z;
}

/* dz = s (u - z) du, what Coleman and Hodgdon's is made of; upwards, from 0: u - 1 + exp(-u). L = 1. */
static hyst_real driven(const void *model, hyst_real u, hyst_real z, hyst_real sign)
{
    (void)model;
    return sign * (u - z);
}

/* What the header says of widths; single precision rounds a few times. */
static void accuracy_is_what_the_header_says(void)
{
    const struct {
        hyst_real share; /* of 1 / L */
        double error;
    } row[] = {{R(0.125), 1e-12}, {R(0.25), 2e-10}, {R(0.5), 6e-8}};
    const struct {
        hyst_real (*slope)(const void *, hyst_real, hyst_real, hyst_real);
        double rate;
    } model[] = {{relaxing, 1.0}, {bounded, 2.0}, {driven, 1.0}};
    const double rounding = 20.0 * (double)REAL_EPSILON;
    for (size_t i = 0; i < COUNT(row); ++i) {
        for (size_t j = 0; j < COUNT(model); ++j) {
            const hyst_branch_equation of = {NULL, model[j].slope,
                                             row[i].share / (hyst_real)model[j].rate};
            hyst_real state[HYST_BRANCH_NODES_LENGTH] = {R(0.0), R(0.0), R(0.0),
                                                         R(0.0), R(0.0), R(0.0)};
            for (size_t k = 1; k <= 40u; ++k) {
                const hyst_real u = (hyst_real)k * R(0.13);
                const double exact[] = {1.0 - exp(-(double)u), tanh((double)u),
                                        (double)u - 1.0 + exp(-(double)u)};
                CHECK_NEAR((double)hyst_branch_step(&of, state, u), exact[j],
                           row[i].error + rounding * (1.0 + exact[j]));
            }
        }
    }
}

/* Out by 1, back by 3: 1 - z = e^-1, then 1 + z = (2 - e^-1) e^-3. */
static void a_turn_begins_a_branch(void)
{
    const hyst_branch_equation of = {NULL, relaxing, R(0.125)};
    hyst_real state[HYST_BRANCH_NODES_LENGTH] = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
    const double tolerance = 1e-12 + 20.0 * (double)REAL_EPSILON;
    CHECK_NEAR((double)hyst_branch_step(&of, state, R(1.0)), 0.6321205588285577, tolerance);
    CHECK_NEAR((double)hyst_branch_step(&of, state, R(-2.0)), -0.9187415021530063, tolerance);
    CHECK_EQUAL(state[HYST_BRANCH_U_TURN], R(1.0));
}

static void samples_in_between_change_nothing(void)
{
    const hyst_branch_equation of = {NULL, driven, R(0.11)};
    hyst_real once[HYST_BRANCH_NODES_LENGTH] = {R(0.3), R(0.1), R(0.3), R(0.1), R(0.0), R(0.1)};
    hyst_real often[HYST_BRANCH_NODES_LENGTH] = {R(0.3), R(0.1), R(0.3), R(0.1), R(0.0), R(0.1)};
    hyst_real slow[HYST_BRANCH_NODES_LENGTH] = {R(0.3), R(0.1), R(0.3), R(0.1), R(0.0), R(0.1)};
    const hyst_real whole = hyst_branch_step(&of, once, R(-2.0));
    for (size_t k = 1; k < 1000u; ++k) {
        hyst_branch_step(&of, often, R(0.3) - (hyst_real)k * R(0.0022));
        hyst_branch_step(&of, slow, R(0.3) - (hyst_real)k * REAL_EPSILON);
    }
    CHECK_EQUAL(hyst_branch_step(&of, often, R(-2.0)), whole);
    CHECK_EQUAL(hyst_branch_step(&of, slow, R(-2.0)), whole);
    CHECK_SAME_BITS(often, once, HYST_BRANCH_NODES_LENGTH);
    CHECK_EQUAL(hyst_branch_step(&of, often, R(-2.0)), whole); /* a rest */
    CHECK_SAME_BITS(often, once, HYST_BRANCH_NODES_LENGTH);
}

/* A way of ten thousand and of 1e30: what was is forgotten, and the count of slopes is bounded. */
static size_t slopes = 0;

static hyst_real counted(const void *model, hyst_real u, hyst_real z, hyst_real sign)
{
    ++slopes;
    return relaxing(model, u, z, sign);
}

static void huge_steps_are_bounded(void)
{
    const hyst_branch_equation of = {NULL, counted, R(0.125)};
    const hyst_real far[] = {R(1e4), R(-1e30)};
    hyst_real state[HYST_BRANCH_NODES_LENGTH] = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
    for (size_t i = 0; i < COUNT(far); ++i) {
        slopes = 0;
        CHECK_NEAR((double)hyst_branch_step(&of, state, far[i]), i == 0u ? 1.0 : -1.0,
                   4.0 * (double)REAL_EPSILON);
        CHECK(slopes <= 11u * (HYST_BRANCH_MOST + 1u));
    }
}

/* A way, or a z, that is no number: answered, the state as it was. */
static hyst_real growing(const void *model, hyst_real u, hyst_real z, hyst_real sign)
{
    (void)model;
    (void)u;
    (void)sign;
    return R(1.0) + z * z;
}

static void what_is_not_finite_leaves_the_state(void)
{
    const hyst_branch_equation of = {NULL, relaxing, R(0.125)}, blows_up = {NULL, growing, R(0.125)};
    const hyst_real before[HYST_BRANCH_NODES_LENGTH] = {R(-0.5) * REAL_MAX, R(0.25), R(-0.5) * REAL_MAX,
                                                        R(0.25), R(0.0), R(0.25)};
    hyst_real state[HYST_BRANCH_NODES_LENGTH];
    memcpy(state, before, sizeof state);
    hyst_real answer = hyst_branch_step(&of, state, REAL_MAX);
    CHECK(!(answer - answer <= R(0.0)));
    CHECK_SAME_BITS(state, before, HYST_BRANCH_NODES_LENGTH);
    hyst_real zero[HYST_BRANCH_NODES_LENGTH] = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
    answer = hyst_branch_step(&blows_up, zero, R(3.0)); /* tan 3 lies beyond its pole */
    CHECK(!(answer - answer <= R(0.0)));
    CHECK_EQUAL(zero[HYST_BRANCH_U], R(0.0));
}

static void turns_are_told_from_going_on(void)
{
    CHECK(hyst_branch_turns(R(0.0), R(1.0), R(0.5)));
    CHECK(hyst_branch_turns(R(0.0), R(-1.0), R(-0.5)));
    CHECK(!hyst_branch_turns(R(0.0), R(1.0), R(1.0)));
    CHECK(!hyst_branch_turns(R(0.0), R(1.0), R(2.0)));
    CHECK(!hyst_branch_turns(R(1.0), R(1.0), R(2.0)));
    CHECK(!hyst_branch_turns(R(1.0), R(1.0), R(0.0)));
}

int main(void)
{
    accuracy_is_what_the_header_says();
    a_turn_begins_a_branch();
    samples_in_between_change_nothing();
    huge_steps_are_bounded();
    what_is_not_finite_leaves_the_state();
    turns_are_told_from_going_on();
    return check_result();
}
