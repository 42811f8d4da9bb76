/* The memory of a repetitive controller against its equations, by hand and in another form. Most
 * constants are powers of two, so nothing is rounded. */
#include "check.h"

#define N 6u
#define H 1u
#define LEAD 1u
#define TAPS 3u

static const hyst_real smooth[] = {R(0.5), R(0.25)}, learn[] = {R(0.125), R(0.25), R(0.5)};

static hyst_repetitive_memory memory_of(int compares)
{
    const hyst_repetitive_memory made = {N, H, LEAD, TAPS, 0u, compares, R(0.25), smooth, learn};
    return made;
}

static void test_length(void)
{
    const hyst_repetitive_memory without = memory_of(0), with = memory_of(1);
    CHECK(hyst_repetitive_memory_length(&without) == 5u + N + H + 2u * TAPS);
    CHECK(hyst_repetitive_memory_length(&with) == 5u + 2u * N + H + 2u * TAPS);
}

/* A single error of 1 at sample 4, before which nothing is known: L spreads it to s_3 (1/2), s_4 (1/4),
 * s_5 (1/8); Q spreads these to w_8 .. w_12, and w_8 to w_13. */
static void test_by_hand(void)
{
    const hyst_repetitive_memory memory = memory_of(0);
    const hyst_real expected[] = {R(0.125), R(0.3125), R(0.28125), R(0.125), R(0.03125), R(0.03125)};
    hyst_real state[5u + N + H + 2u * TAPS] = {0};
    int changed = 0;
    for (size_t k = 0; k < 14u; ++k) {
        const hyst_real y = k == 4u ? R(-1.0) : R(0.0);
        const hyst_real v = hyst_repetitive_wanted(&memory, state, R(0.0), y, &changed);
        hyst_repetitive_learn(&memory, state, R(0.0));
        CHECK_EQUAL(v, k < 8u ? R(0.0) : expected[k - 8u]);
    }
    CHECK(changed == 0);
}

/* Plain arrays of all samples, as the equations are written. */
static void test_is_its_equations(void)
{
    enum { SAMPLES = 300, ROOM = 8 };
    const hyst_repetitive_memory memory = memory_of(0);
    hyst_real s[SAMPLES + 2 * ROOM] = {0}, e[SAMPLES + 2 * ROOM] = {0}, y_ref[SAMPLES], y[SAMPLES];
    hyst_real state[5u + N + H + 2u * TAPS] = {0};
    int changed = 0;
    fill_with_noise(y_ref, SAMPLES, R(2.0));
    fill_with_noise(y, SAMPLES, R(3.0));
    for (size_t k = 0; k < SAMPLES; ++k) {
        const size_t at = k + ROOM;
        const hyst_real w = smooth[0] * s[at - N] + smooth[1] * (s[at - N - 1u] + s[at - N + 1u]);
        const hyst_real v = hyst_repetitive_wanted(&memory, state, y_ref[k], y[k], &changed);
        const hyst_real expected = y_ref[k] + w;
        CHECK_SAME_BITS(&v, &expected, 1);
        hyst_repetitive_learn(&memory, state, R(0.0));
        s[at] = w;
        e[at] = y_ref[k] - y[k];
        if (k >= LEAD) {
            s[at - LEAD] += R(0.0) + learn[0] * e[at - 2u] + learn[1] * e[at - 1u] + learn[2] * e[at];
        }
    }
}

/* A lost sample teaches nothing for as long as L sees it, and the memory stays in step. */
static void test_lost_samples(void)
{
    const hyst_repetitive_memory memory = memory_of(0);
    hyst_real state[5u + N + H + 2u * TAPS] = {0};
    int changed = 0;
    for (size_t k = 0; k < 13u; ++k) {
        const hyst_real y = k == 6u ? (hyst_real)NAN : (k == 4u || k == 7u ? R(-1.0) : R(0.0));
        const hyst_real v = hyst_repetitive_wanted(&memory, state, R(0.0), y, &changed);
        CHECK(hyst_is_finite(v) == (k != 6u));
        hyst_repetitive_learn(&memory, state, R(0.0));
        /* Of the error at 4 only s_3 = 1/2 and s_4 = 1/4 are learned, of that at 7 s_8 alone. */
        if (k == 9u) {
            CHECK_EQUAL(v, R(0.3125));
        } else if (k == 11u) {
            CHECK_EQUAL(v, R(0.0625)); /* of s_4 */
        } else if (k == 12u) {
            CHECK_EQUAL(v, R(0.0));
        }
    }
    for (size_t i = 0; i < COUNT(state); ++i) {
        CHECK(hyst_is_finite(state[i]) != 0);
    }
}

/* Where the drive was held below what was wanted, more is not learned, and less is. */
static void test_learns_no_further_into_a_limit(void)
{
    const hyst_repetitive_memory memory = memory_of(0);
    for (int sign = -1; sign <= 1; sign += 2) {
        hyst_real state[5u + N + H + 2u * TAPS] = {0}, v = R(0.0);
        int changed = 0;
        for (size_t k = 0; k < 5u + N; ++k) {
            const hyst_real y = k == 5u ? -(hyst_real)sign : R(0.0);
            v = hyst_repetitive_wanted(&memory, state, R(0.0), y, &changed);
            hyst_repetitive_learn(&memory, state, k == 4u ? R(-2.0) : R(0.0));
        }
        /* At sample 10: s_4 = 0, or -1/2 by the error at 5; s_5 = +-1/4, s_3 = 0. */
        CHECK_EQUAL(v, sign > 0 ? R(0.0625) : R(-0.3125));
    }
}

/* Samples at the start teach nothing, and those after them do, the first one too. */
static void test_waits(void)
{
    hyst_repetitive_memory memory = memory_of(0);
    memory.wait = 2u * N;
    hyst_real state[5u + N + H + 2u * TAPS] = {0};
    int changed = 0;
    for (size_t k = 0; k < 3u * N + 2u; ++k) {
        const hyst_real v = hyst_repetitive_wanted(&memory, state, R(0.0), -R(1.0), &changed);
        hyst_repetitive_learn(&memory, state, R(0.0));
        /* s_12 = 7/8 is the first; Q of s_12 and s_13 gives w_17 = 7/32, then 21/32, then 7/8. */
        const hyst_real expected = k < 17u ? R(0.0) : (k == 17u ? R(0.21875) : R(0.65625));
        CHECK_EQUAL(v, k < 19u ? expected : R(0.875));
    }
}

static void test_reference_that_changes(void)
{
    const hyst_repetitive_memory memory = memory_of(1);
    hyst_real state[5u + 2u * N + H + 2u * TAPS] = {0};
    int changed = 0;
    for (size_t k = 0; k < 40u; ++k) {
        /* A quarter is within the tolerance; from sample 20 on the phase is another one. */
        const size_t phase = (k < 20u ? k : k + 3u) % N;
        const hyst_real y_ref = (hyst_real)phase + (k == 13u ? R(0.25) : R(0.0));
        const hyst_real v = hyst_repetitive_wanted(&memory, state, y_ref, y_ref - R(1.0), &changed);
        hyst_repetitive_learn(&memory, state, R(0.0));
        CHECK(changed == (k >= 20u));
        if (k >= 20u && k < 20u + N - 2u) {
            CHECK_EQUAL(v, y_ref); /* nothing is known of the new one */
        }
    }
    hyst_repetitive_forget(&memory, state);
    for (size_t i = 0; i < COUNT(state); ++i) {
        CHECK_EQUAL(state[i], R(0.0));
    }
}

/* Numbers no count can be, as from memory that was never set, reach outside no ring. */
static void test_damaged_counts(void)
{
    const hyst_repetitive_memory memory = memory_of(1);
    const hyst_real damaged[] = {R(-3.0), R(1e30), (hyst_real)NAN, (hyst_real)INFINITY};
    for (size_t i = 0; i < COUNT(damaged); ++i) {
        hyst_real state[5u + 2u * N + H + 2u * TAPS] = {0};
        int changed = 0;
        for (size_t place = 0; place < 5u; ++place) {
            state[place] = damaged[i];
        }
        const hyst_real v = hyst_repetitive_wanted(&memory, state, R(2.0), R(2.0), &changed);
        hyst_repetitive_learn(&memory, state, R(0.0));
        CHECK_EQUAL(v, R(2.0));
    }
}

int main(void)
{
    test_length();
    test_by_hand();
    test_is_its_equations();
    test_lost_samples();
    test_learns_no_further_into_a_limit();
    test_waits();
    test_reference_that_changes();
    test_damaged_counts();
    return check_result();
}
