/* Dahl's friction against numbers by hand. */
#include "hyst/dahl.h"

#include "check.h"

#define CLOSE (60.0 * (double)REAL_EPSILON)

static hyst_dahl friction(hyst_real n, int inverse)
{
    hyst_dahl model; /* sigma = 6, Fc = 3 */
    model.force = R(3.0);
    model.rate = R(2.0);
    model.excess = n - R(1.0);
    model.inverse = inverse;
    return model;
}

/* Ways of 2 du = 1 out and back: w' = w exp(-1); w / (1 + w); (sqrt(w) - 1/2)^2. */
static void closed_forms_by_hand(void)
{
    const struct {
        hyst_real n;
        double out, back;
    } row[] = {{R(1.0), 0.6321205588285577, -0.39957640089372803},
               {R(2.0), 0.5, -0.4},
               {R(0.5), 0.75, -0.32287565553229525}};
    for (size_t i = 0; i < COUNT(row); ++i) {
        const hyst_dahl model = friction(row[i].n, 0), inverse = friction(row[i].n, 1);
        hyst_real there[4] = {R(0.0), R(0.0), R(0.0), R(0.0)}, home[4] = {R(0.0), R(0.0), R(0.0), R(0.0)};
        const hyst_real out = hyst_dahl_step(&model, there, R(0.5));
        CHECK_NEAR((double)out, 3.0 * row[i].out, CLOSE);
        CHECK_NEAR((double)hyst_dahl_step(&inverse, home, out), 0.5, CLOSE);
        const hyst_real back = hyst_dahl_step(&model, there, R(0.0));
        CHECK_NEAR((double)back, 3.0 * row[i].back, CLOSE);
        CHECK_NEAR((double)hyst_dahl_step(&inverse, home, back), 0.0, CLOSE);
    }
}

/* Half a way twice is the way once, to the bit, and so are many ways too small to be seen in z. */
static void samples_in_between_change_nothing(void)
{
    const hyst_real shape[] = {R(0.7), R(1.0), R(1.3), R(2.5)};
    for (size_t i = 0; i < COUNT(shape); ++i) {
        const hyst_dahl model = friction(shape[i], 0);
        hyst_real once[4] = {R(0.0), R(-0.25), R(0.0), R(-0.25)}, twice[4] = {R(0.0), R(-0.25), R(0.0), R(-0.25)};
        const hyst_real whole = hyst_dahl_step(&model, once, R(0.6));
        hyst_dahl_step(&model, twice, R(0.3));
        CHECK_EQUAL(hyst_dahl_step(&model, twice, R(0.6)), whole);
        hyst_real slow[4] = {R(0.0), R(-0.25), R(0.0), R(-0.25)};
        for (size_t k = 1; k < 1000u; ++k) {
            hyst_dahl_step(&model, slow, (hyst_real)k * REAL_EPSILON / R(64.0));
        }
        CHECK_EQUAL(hyst_dahl_step(&model, slow, R(0.6)), whole);
    }
}

static void rest_changes_nothing(void)
{
    const hyst_dahl model = friction(R(1.0), 0), inverse = friction(R(1.0), 1);
    hyst_real state[4] = {R(0.5), R(0.25), R(0.5), R(0.25)};
    CHECK_EQUAL(hyst_dahl_step(&model, state, R(0.5)), R(0.75));
    CHECK_EQUAL(hyst_dahl_step(&inverse, state, R(0.75)), R(0.5));
    CHECK_EQUAL(state[1], R(0.25));
}

/* n = 1/2 slides after a way of 2, 2 du = 2, and stays; a long way of n = 1 ends at Fc. */
static void sliding_keeps_the_force(void)
{
    const hyst_dahl ductile = friction(R(0.5), 0), first = friction(R(1.0), 0);
    hyst_real state[4] = {R(0.0), R(0.0), R(0.0), R(0.0)}, far[4] = {R(0.0), R(0.0), R(0.0), R(0.0)};
    CHECK_EQUAL(hyst_dahl_step(&ductile, state, R(1.0)), R(3.0));
    CHECK_EQUAL(hyst_dahl_step(&ductile, state, R(7.0)), R(3.0));
    CHECK_EQUAL(hyst_dahl_step(&first, far, REAL_MAX), R(3.0));
    CHECK_EQUAL(hyst_dahl_step(&first, far, -REAL_MAX), R(-3.0));
}

/* A force of Fc or more has no position: the answer is not finite, and the state stays. */
static void the_inverse_refuses_what_no_way_reaches(void)
{
    const hyst_dahl inverse = friction(R(1.0), 1);
    const hyst_real force[] = {R(3.0), R(4.0), R(-3.0), R(-1e6)};
    for (size_t i = 0; i < COUNT(force); ++i) {
        hyst_real state[4] = {R(0.5), R(0.25), R(0.5), R(0.25)};
        const hyst_real answer = hyst_dahl_step(&inverse, state, force[i]);
        CHECK(!(answer - answer <= R(0.0)));
        CHECK_EQUAL(state[0], R(0.5));
        CHECK_EQUAL(state[1], R(0.25));
    }
}

/* 1 - z = 1e-6 and n = 70 ask for a way of about 1e6^69: a force within the limit, and no number. */
static void an_overflow_leaves_the_state(void)
{
    const hyst_dahl inverse = friction(R(70.0), 1);
    hyst_real state[4] = {R(0.5), R(0.25), R(0.5), R(0.25)};
    const hyst_real answer = hyst_dahl_step(&inverse, state, R(2.999997));
    CHECK(!(answer - answer <= R(0.0)));
    CHECK_EQUAL(state[0], R(0.5));
    CHECK_EQUAL(state[1], R(0.25));
}

/* Friction of a way of 1e-6 eps: sigma times the way, with all its digits. */
static void a_small_way_keeps_its_digits(void)
{
    const hyst_dahl model = friction(R(2.0), 0), inverse = friction(R(2.0), 1);
    hyst_real there[4] = {R(0.0), R(0.0), R(0.0), R(0.0)}, home[4] = {R(0.0), R(0.0), R(0.0), R(0.0)};
    const hyst_real way = R(1e-6) * REAL_EPSILON;
    const hyst_real force = hyst_dahl_step(&model, there, way);
    CHECK_NEAR((double)(force / way), 6.0, CLOSE);
    CHECK_NEAR((double)(hyst_dahl_step(&inverse, home, force) / way), 1.0, CLOSE);
}

int main(void)
{
    closed_forms_by_hand();
    samples_in_between_change_nothing();
    rest_changes_nothing();
    sliding_keeps_the_force();
    the_inverse_refuses_what_no_way_reaches();
    an_overflow_leaves_the_state();
    a_small_way_keeps_its_digits();
    return check_result();
}
