/* The repetitive controller against its memory and its inverse, each taken by itself. */
#include "check.h"

#define N 8u

static const hyst_real smooth[] = {R(0.5), R(0.25)}, learn[] = {R(0.25), R(0.5)};
static const hyst_repetitive_memory memory = {N, 1, 1, 2, 3, 0, R(0.0), smooth, learn};
static const hyst_real p[] = {R(0.5)}, r[] = {R(1.0)}, g[] = {R(-1.0)}, s[] = {R(0.5)};
static const hyst_pi stage_pi = {1, R(0.5), p, r}, inverse_pi = {1, R(2.0), g, s};
static const hyst_stage stage_stages[] = {{&hyst_pi_kind, &stage_pi}};
static const hyst_stage inverse_stages[] = {{&hyst_pi_kind, &inverse_pi}};
static const hyst_chain inverse = {1, inverse_stages};

enum { LENGTH = 5u + N + 1u + 4u, SAMPLES = 200 };

static hyst_limited_inverse limited_at(hyst_real limit)
{
    const hyst_limited_inverse made = {
        {1, inverse_stages}, {1, stage_stages}, {-limit, limit, R(0.0)}};
    return made;
}

static void test_is_memory_and_inverse(void)
{
    hyst_real state[LENGTH + 1] = {0}, own[LENGTH] = {0}, inner[1] = {0}, y_ref[SAMPLES], y[SAMPLES];
    hyst_real v = R(0.0);
    hyst_guard guard = {R(0.0), 0};
    int changed = 0;
    fill_with_noise(y_ref, SAMPLES, R(3.0));
    fill_with_noise(y, SAMPLES, R(2.0));
    for (size_t k = 0; k < SAMPLES; ++k) {
        const hyst_real wanted = hyst_repetitive_wanted(&memory, own, y_ref[k], y[k], &changed);
        hyst_repetitive_learn(&memory, own, R(0.0));
        const hyst_real expected = hyst_chain_step(&inverse, inner, wanted);
        const hyst_real u =
            hyst_repetitive_step(&memory, &inverse, state, &guard, y_ref[k], y[k], &v, &changed);
        CHECK_SAME_BITS(&u, &expected, 1);
        CHECK_SAME_BITS(&v, &wanted, 1);
        CHECK_SAME_BITS(state, own, LENGTH);
    }
    CHECK(guard.fault == 0);
}

/* Within its limits a limited one has the bits of one without. */
static void test_within_limits_nothing_changes(void)
{
    const hyst_limited_inverse limited = limited_at(R(1000.0));
    hyst_real state[LENGTH + 3] = {0}, other[LENGTH + 1] = {0}, before[1], y_ref[SAMPLES], y[SAMPLES];
    hyst_real v = R(0.0), w = R(0.0);
    hyst_limited_guard guard = {{R(0.0), 0}, 0};
    hyst_guard plain = {R(0.0), 0};
    int changed = 0;
    fill_with_noise(y_ref, SAMPLES, R(3.0));
    fill_with_noise(y, SAMPLES, R(2.0));
    for (size_t k = 0; k < SAMPLES; ++k) {
        const hyst_real u = hyst_limited_repetitive_step(&memory, &limited, state, before, &guard,
                                                         y_ref[k], y[k], &v, &changed);
        const hyst_real expected =
            hyst_repetitive_step(&memory, &inverse, other, &plain, y_ref[k], y[k], &w, &changed);
        CHECK_SAME_BITS(&u, &expected, 1);
        CHECK_SAME_BITS(state, other, LENGTH + 1);
    }
    CHECK(guard.limited == 0 && guard.guard.fault == 0);
}

/* An output that never comes near asks for more and more; what is remembered is what was applied. */
static void test_does_not_wind_up(void)
{
    const hyst_limited_inverse limited = limited_at(R(2.0));
    hyst_real state[LENGTH + 3] = {0}, before[1], v = R(0.0), u = R(0.0);
    hyst_limited_guard guard = {{R(0.0), 0}, 0};
    int changed = 0;
    for (size_t k = 0; k < 100u * N; ++k) {
        u = hyst_limited_repetitive_step(&memory, &limited, state, before, &guard, R(1.0), R(0.0), &v,
                                         &changed);
        CHECK(u <= R(2.0) && u >= R(-2.0));
    }
    CHECK_EQUAL(u, R(2.0));
    CHECK(guard.limited == 1);
    /* 0.5 u + 0.5 (u - 1): u = 2 gives 1.5, so that w = v - y_ref is 0.5, and what is remembered at
     * most one lesson of 0.25 + 0.5 more. */
    CHECK_EQUAL(v, R(1.5));
    for (size_t i = 5u; i < 5u + N + 1u; ++i) {
        CHECK(state[i] <= R(1.25));
    }
    /* It comes back within one period and what L sees of the sample before. */
    for (size_t k = 0; k < N + 2u; ++k) {
        u = hyst_limited_repetitive_step(&memory, &limited, state, before, &guard, R(1.0), R(3.0), &v,
                                         &changed);
    }
    CHECK(u < R(2.0));
}

static void test_bad_samples(void)
{
    const hyst_limited_inverse limited = limited_at(R(8.0));
    const hyst_real bad[] = {(hyst_real)NAN, (hyst_real)INFINITY, -(hyst_real)INFINITY};
    for (size_t i = 0; i < 2u * COUNT(bad); ++i) {
        hyst_real state[LENGTH + 3] = {0}, other[LENGTH + 1] = {0}, before[1], v = R(9.0);
        hyst_limited_guard guard = {{R(0.0), 0}, 0};
        hyst_guard plain = {R(0.0), 0};
        int changed = 0;
        const hyst_real wrong = bad[i / 2u], y_ref = i % 2u == 0u ? wrong : R(1.0);
        const hyst_real y = i % 2u == 0u ? R(1.0) : wrong;
        const hyst_real first = hyst_limited_repetitive_step(&memory, &limited, state, before, &guard,
                                                             R(3.0), R(3.0), &v, &changed);
        const hyst_real second = hyst_limited_repetitive_step(&memory, &limited, state, before, &guard,
                                                              y_ref, y, &v, &changed);
        CHECK_EQUAL(second, first);
        CHECK_EQUAL(v, R(3.0));
        CHECK(guard.guard.fault == 1 && guard.limited == 0);
        CHECK_EQUAL(state[0], R(2.0)); /* time goes on */
        (void)hyst_repetitive_step(&memory, &inverse, other, &plain, R(3.0), R(3.0), &v, &changed);
        CHECK_EQUAL(hyst_repetitive_step(&memory, &inverse, other, &plain, y_ref, y, &v, &changed),
                    first);
        CHECK(plain.fault == 1);
        for (size_t j = 0; j < LENGTH + 1u; ++j) {
            CHECK(hyst_is_finite(state[j]) != 0 && hyst_is_finite(other[j]) != 0);
        }
    }
}

int main(void)
{
    test_is_memory_and_inverse();
    test_within_limits_nothing_changes();
    test_does_not_wind_up();
    test_bad_samples();
    return check_result();
}
