/* Plays between two envelopes against numbers by hand. */
#include "hyst/two_envelope.h"

#include "check.h"

#define CLOSE (40.0 * (double)REAL_EPSILON)

/* up: slope 1, 1/2 beyond 1.  down: slope 1, 1/2 below -1. One play of r = 1 and weight 1/2. */
static const hyst_real weights[] = {R(1.0), R(-0.5)};
static const hyst_real up_at[] = {R(0.0), R(1.0)};
static const hyst_real down_at[] = {R(0.0), R(-1.0)};
static const hyst_real knots[] = {R(-1.0), R(0.0), R(1.0)};
static const hyst_real half[] = {R(0.5), R(0.25)};
static const hyst_real radius[] = {R(1.0), R(1.5)};

static hyst_two_envelope plays(size_t count, int inverse)
{
    hyst_two_envelope model;
    model.count = count;
    model.p0 = R(1.0);
    model.p = half;
    model.r = radius;
    model.up.count = model.down.count = 2u;
    model.up.weight = model.down.weight = weights;
    model.up.threshold = up_at;
    model.down.threshold = down_at;
    model.knots = 3u;
    model.knot = knots;
    model.inverse = inverse;
    return model;
}

/* u      2     -2     1      3
 * up     1.5   -2     1      2
 * down   2     -1.5   1      3
 * z      0.5   -0.5   0      1
 * y = (up + down) / 2 + z / 2 */
static const hyst_real input[] = {R(2.0), R(-2.0), R(1.0), R(3.0)};
static const double output[] = {2.0, -2.0, 1.0, 3.0};

static void loops_by_hand(void)
{
    const hyst_two_envelope model = plays(1u, 0), inverse = plays(1u, 1);
    hyst_real there[1] = {R(0.0)}, back[4] = {R(0.0), R(0.0), R(0.0), R(1.0)};
    for (size_t k = 0; k < COUNT(input); ++k) {
        const hyst_real y = hyst_two_envelope_step(&model, there, input[k]);
        CHECK_NEAR((double)y, output[k], CLOSE);
        CHECK_NEAR((double)hyst_two_envelope_step(&inverse, back, y), (double)input[k], CLOSE);
        CHECK_NEAR((double)back[0], (double)there[0], CLOSE);
    }
}

/* Equal envelopes at 0.7: the plays' own numbers, up = down = 0.7. */
static void equal_envelopes_are_one(void)
{
    hyst_two_envelope model = plays(2u, 0);
    hyst_real z[2] = {R(0.0), R(0.0)};
    model.down.threshold = up_at;
    /* up = down = 2.5 at 4: y = 2.5 + (2.5 - 1) / 2 + (2.5 - 1.5) / 4. */
    CHECK_NEAR((double)hyst_two_envelope_step(&model, z, R(4.0)), 3.5, CLOSE);
    /* 1 at 1: both plays rest, 2.5 - 1 = 1.5 <= 1 + 1. */
    CHECK_NEAR((double)hyst_two_envelope_step(&model, z, R(1.0)), 2.0, CLOSE);
}

static void rest_changes_nothing(void)
{
    const hyst_two_envelope inverse = plays(2u, 1);
    hyst_real state[5] = {R(0.0), R(0.0), R(0.0), R(0.0), R(1.0)}, kept[5];
    const hyst_real u = hyst_two_envelope_step(&inverse, state, R(1.7));
    for (size_t i = 0; i < 5u; ++i) {
        kept[i] = state[i];
    }
    CHECK_EQUAL(hyst_two_envelope_step(&inverse, state, R(1.7)), u);
    for (size_t i = 0; i < 5u; ++i) {
        CHECK_EQUAL(state[i], kept[i]);
    }
}

/* A walk of turns of all sizes, there and back. Slopes between 1/2 and 1.75, so that rounding of y, at
 * most some 40 roundings of numbers up to 20, comes back at most doubled. */
static void there_and_back(void)
{
    const hyst_two_envelope model = plays(2u, 0), inverse = plays(2u, 1);
    hyst_real there[2] = {R(0.0), R(0.0)}, back[5] = {R(0.0), R(0.0), R(0.0), R(0.0), R(1.0)};
    unsigned seed = 5u;
    for (size_t k = 0; k < 2000u; ++k) {
        seed = seed * 1103515245u + 12345u;
        const hyst_real u = (hyst_real)((seed >> 16) & 1023u) / R(64.0) - R(8.0);
        const hyst_real y = hyst_two_envelope_step(&model, there, u);
        CHECK_NEAR((double)hyst_two_envelope_step(&inverse, back, y), (double)u,
                   1600.0 * (double)REAL_EPSILON);
    }
}

/* What overflows has no input: the answer is not finite, and the state stays. */
static void an_overflow_leaves_the_state(void)
{
    hyst_two_envelope inverse = plays(1u, 1);
    hyst_real state[4] = {R(0.25), R(0.5), R(0.5), R(1.0)};
    inverse.p0 = R(1e-3);
    const hyst_real answer = hyst_two_envelope_step(&inverse, state, -REAL_MAX);
    CHECK(!(answer - answer <= R(0.0)));
    CHECK_EQUAL(state[0], R(0.25));
    CHECK_EQUAL(state[1], R(0.5));
    CHECK_EQUAL(state[2], R(0.5));
}

int main(void)
{
    loops_by_hand();
    equal_envelopes_are_one();
    rest_changes_nothing();
    there_and_back();
    an_overflow_leaves_the_state();
    return check_result();
}
