/* Bouc-Wen's model against numbers by hand. */
#include "hyst/bouc_wen.h"

#include "hyst/bouc_wen_branch.h"

#include "check.h"

#define CLOSE (40.0 * (double)REAL_EPSILON)

/* k = 2, A = 1, beta = 3/4, gamma = 1/4: limit 1, rate 1, ratio 1/2. */
static hyst_bouc_wen model_of(hyst_real n, hyst_real h, int inverse)
{
    hyst_bouc_wen model;
    model.stiffness = R(2.0);
    model.share = h;
    model.exponent = n;
    model.join = hyst_bouc_wen_join(n);
    model.up.limit = model.up.rate = R(1.0);
    model.up.ratio = R(0.5);
    model.down = model.up;
    model.inverse = inverse;
    return model;
}

/* n = 1, out by 1 and back by 2: 1 - 1/e; the way down to z = 0 is 2 ln(1 + (1 - 1/e) / 2), and what is
 * left of 2 brings z to -(1 - exp(-left)). n = 2: tanh 1; down to 0 sqrt(2) arctan(tanh(1) / sqrt(2)),
 * then -tanh(left). */
static void closed_forms_by_hand(void)
{
    const struct {
        hyst_real n;
        double out, back;
    } row[] = {{R(1.0), 0.6321205588285577, -0.7655973055472338},
               {R(2.0), 0.7615941559557649, -0.8620800815190324}};
    const hyst_real shares[] = {R(1.0), R(-1.0)};
    for (size_t i = 0; i < COUNT(row); ++i) {
        for (size_t j = 0; j < COUNT(shares); ++j) {
            const hyst_bouc_wen model = model_of(row[i].n, shares[j], 0);
            const hyst_bouc_wen inverse = model_of(row[i].n, shares[j], 1);
            hyst_real there[4] = {R(0.0), R(0.0), R(0.0), R(0.0)};
            hyst_real home[6] = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
            const hyst_real out = hyst_bouc_wen_step(&model, there, R(1.0));
            CHECK_NEAR((double)out, 2.0 + (double)shares[j] * row[i].out, CLOSE);
            CHECK_NEAR((double)hyst_bouc_wen_step(&inverse, home, out), 1.0, CLOSE);
            const hyst_real back = hyst_bouc_wen_step(&model, there, R(-1.0));
            CHECK_NEAR((double)back, -2.0 + (double)shares[j] * row[i].back, CLOSE);
            CHECK_NEAR((double)hyst_bouc_wen_step(&inverse, home, back), -1.0, CLOSE);
        }
    }
}

/* Half a way twice is the way once, to the bit, and so are many ways too small to be seen in z. */
static void samples_in_between_change_nothing(void)
{
    const hyst_real exponents[] = {R(0.7), R(1.0), R(2.5)};
    for (size_t i = 0; i < COUNT(exponents); ++i) {
        const hyst_bouc_wen model = model_of(exponents[i], R(-1.0), 0);
        hyst_real once[4] = {R(0.0), R(-0.25), R(0.0), R(-0.25)};
        hyst_real twice[4] = {R(0.0), R(-0.25), R(0.0), R(-0.25)};
        hyst_real slow[4] = {R(0.0), R(-0.25), R(0.0), R(-0.25)};
        const hyst_real whole = hyst_bouc_wen_step(&model, once, R(0.6));
        hyst_bouc_wen_step(&model, twice, R(0.1));
        hyst_bouc_wen_step(&model, twice, R(0.3));
        CHECK_EQUAL(hyst_bouc_wen_step(&model, twice, R(0.6)), whole);
        for (size_t k = 1; k < 1000u; ++k) {
            hyst_bouc_wen_step(&model, slow, (hyst_real)k * REAL_EPSILON / R(64.0));
        }
        CHECK_EQUAL(hyst_bouc_wen_step(&model, slow, R(0.6)), whole);
    }
}

static void rest_changes_nothing(void)
{
    const hyst_bouc_wen model = model_of(R(1.5), R(1.0), 0), inverse = model_of(R(1.5), R(1.0), 1);
    hyst_real state[4] = {R(0.5), R(0.25), R(0.5), R(0.25)};
    hyst_real home[6] = {R(0.5), R(0.25), R(0.5), R(0.25), R(1.25), R(1.25)};
    CHECK_EQUAL(hyst_bouc_wen_step(&model, state, R(0.5)), R(1.25));
    CHECK_EQUAL(hyst_bouc_wen_step(&inverse, home, R(1.25)), R(0.5));
    CHECK_EQUAL(state[1], R(0.25));
    CHECK_EQUAL(home[1], R(0.25));
}

/* A long way ends at the limit, the other one below: there y has the slope k alone. */
static void the_limit_is_kept(void)
{
    hyst_bouc_wen model = model_of(R(1.5), R(1.0), 0);
    model.down.limit = R(0.5);
    hyst_real state[4] = {R(0.0), R(0.0), R(0.0), R(0.0)};
    CHECK_EQUAL(hyst_bouc_wen_step(&model, state, R(1024.0)), R(2049.0));
    CHECK_EQUAL(hyst_bouc_wen_step(&model, state, R(2048.0)), R(4097.0));
    CHECK_EQUAL(hyst_bouc_wen_step(&model, state, R(-2048.0)), R(-4096.5));
}

/* A y that is no number is answered by none, and the state stays. */
static void an_overflow_leaves_the_state(void)
{
    const hyst_bouc_wen model = model_of(R(1.5), R(1.0), 0);
    hyst_real state[4] = {R(0.5), R(0.25), R(0.5), R(0.25)};
    const hyst_real answer = hyst_bouc_wen_step(&model, state, REAL_MAX);
    CHECK(!(answer - answer <= R(0.0)));
    CHECK_EQUAL(state[0], R(0.5));
    CHECK_EQUAL(state[1], R(0.25));
}

/* From a z of 0 a way of 1e-6 eps: k + h A times the way, with all its digits. */
static void a_small_way_keeps_its_digits(void)
{
    const hyst_bouc_wen model = model_of(R(1.3), R(-1.0), 0), inverse = model_of(R(1.3), R(-1.0), 1);
    hyst_real there[4] = {R(0.0), R(0.0), R(0.0), R(0.0)};
    hyst_real home[6] = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
    const hyst_real way = R(1e-6) * REAL_EPSILON;
    const hyst_real y = hyst_bouc_wen_step(&model, there, way);
    CHECK_NEAR((double)(y / way), 1.0, CLOSE);
    CHECK_NEAR((double)(hyst_bouc_wen_step(&inverse, home, y) / way), 1.0, CLOSE);
}

int main(void)
{
    closed_forms_by_hand();
    samples_in_between_change_nothing();
    rest_changes_nothing();
    the_limit_is_kept();
    an_overflow_leaves_the_state();
    a_small_way_keeps_its_digits();
    return check_result();
}
