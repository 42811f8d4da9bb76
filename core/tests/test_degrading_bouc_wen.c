/* Bouc-Wen's model that degrades and pinches: closed forms, its inverse, and what is between samples. */
#include "hyst/degrading_bouc_wen.h"

#include "check.h"

#define CLOSE (100.0 * (double)REAL_EPSILON + 1e-11)

/* k = 2, A = 1, beta = 3/4, gamma = 1/4: limit 1, rate 1, ratio 1/2. */
static hyst_degrading_bouc_wen model_of(int wears, int inverse)
{
    hyst_degrading_bouc_wen model = {R(2.0), R(1.0), R(1.0),
                                     {R(1.0), R(0.5), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(1.0),
                                      R(0.0), R(1.0)},
                                     0};
    if (wears) {
        model.loop.delta_nu = R(0.125);
        model.loop.delta_eta = R(0.25);
        model.loop.zeta = R(0.75);
        model.loop.p = R(1.0);
        model.loop.q = R(0.25);
        model.loop.psi = R(0.5);
    }
    model.inverse = inverse;
    return model;
}

/* Out by 1 and back by 2 as Bouc-Wen's own: test_bouc_wen.c. */
static void a_new_loop_is_bouc_wens(void)
{
    const hyst_degrading_bouc_wen model = model_of(0, 0);
    hyst_real state[7] = {R(0.0)};
    CHECK_NEAR((double)hyst_degrading_bouc_wen_step(&model, state, R(1.0)), 2.6321205588285577, CLOSE);
    CHECK_NEAR((double)hyst_degrading_bouc_wen_step(&model, state, R(-1.0)), -2.7655973055472338,
               CLOSE);
}

static void the_inverse_goes_back(void)
{
    const hyst_real u[] = {R(1.0), R(-1.5), R(-1.25), R(2.0), R(2.0), R(0.5), R(7.0), R(-3.0)};
    const hyst_degrading_bouc_wen model = model_of(1, 0), inverse = model_of(1, 1);
    hyst_real there[7] = {R(0.0)}, home[9] = {R(0.0)};
    for (size_t k = 0; k < COUNT(u); ++k) {
        const hyst_real y = hyst_degrading_bouc_wen_step(&model, there, u[k]);
        CHECK_NEAR((double)hyst_degrading_bouc_wen_step(&inverse, home, y), (double)u[k],
                   100.0 * (double)REAL_EPSILON);
    }
}

static void samples_in_between_change_nothing(void)
{
    const hyst_degrading_bouc_wen model = model_of(1, 0);
    hyst_real once[7] = {R(0.0)}, often[7] = {R(0.0)};
    const hyst_real turns[] = {R(1.5), R(-1.0), R(0.75), R(-2.0)};
    hyst_real last = R(0.0);
    for (size_t k = 0; k < COUNT(turns); ++k) {
        hyst_degrading_bouc_wen_step(&model, once, turns[k]);
        for (size_t j = 1; j <= 64u; ++j) {
            hyst_degrading_bouc_wen_step(&model, often,
                                         last + (turns[k] - last) * ((hyst_real)j / R(64.0)));
        }
        last = turns[k];
        CHECK_SAME_BITS(often, once, 7);
    }
}

static void what_is_too_far_or_not_finite_is_answered_and_not_kept(void)
{
    const hyst_degrading_bouc_wen model = model_of(1, 0);
    hyst_real state[7] = {R(0.0)}, before[7];
    hyst_degrading_bouc_wen_step(&model, state, R(0.5));
    memcpy(before, state, sizeof state);
    const hyst_real far = hyst_degrading_bouc_wen_step(&model, state, R(1e9));
    CHECK(!(far - far == R(0.0)));
    CHECK_SAME_BITS(state, before, 7);
    const hyst_real infinite = hyst_degrading_bouc_wen_step(&model, state, REAL_MAX * R(2.0));
    CHECK(!(infinite - infinite == R(0.0)));
    CHECK_SAME_BITS(state, before, 7);
}

static void row_asks_for_its_numbers(void)
{
    const hyst_degrading_bouc_wen model = model_of(1, 0), inverse = model_of(1, 1);
    hyst_real state[7] = {R(0.0)};
    CHECK(hyst_degrading_bouc_wen_kind.length(&model) == 7u);
    CHECK(hyst_degrading_bouc_wen_kind.length(&inverse) == 9u);
    CHECK_EQUAL(hyst_degrading_bouc_wen_kind.step(&model, state, R(0.0)), R(0.0));
}

int main(void)
{
    a_new_loop_is_bouc_wens();
    the_inverse_goes_back();
    samples_in_between_change_nothing();
    what_is_too_far_or_not_finite_is_answered_and_not_kept();
    row_asks_for_its_numbers();
    return check_result();
}
