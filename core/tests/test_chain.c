#include "check.h"

/* A chain with a stage of every kind. Its constants are exact in float and double. */
static const hyst_real map_weight[] = {R(1.0), R(0.5), R(0.25)};
static const hyst_real map_threshold[] = {R(0.0), R(1.5), R(-2.0)};
static const hyst_real p[] = {R(0.5), R(0.25), R(0.125)};
static const hyst_real r[] = {R(0.25), R(1.0), R(3.0)};

static const hyst_stage stages[] = {
    {&hyst_affine_kind, &(const hyst_affine){R(1.5), R(-0.25)}},
    {&hyst_dead_zone_kind, &(const hyst_dead_zone){3, map_weight, map_threshold}},
    {&hyst_pi_kind, &(const hyst_pi){3, R(0.75), p, r}},
    {&hyst_play_kind, &(const hyst_real){R(0.5)}},
    {&hyst_stop_kind, &(const hyst_real){R(6.0)}},
    {&hyst_direction_dead_zone_kind, &(const hyst_dead_zone){2, map_weight, map_threshold}},
};
static const hyst_chain chain = {COUNT(stages), stages};

enum { samples = 1000, state_length = 0 + 0 + 3 + 1 + 1 + 1 };

static hyst_real u[samples];

static void state_is_one_value_a_play_and_one_a_previous_input(void)
{
    const size_t expected[] = {0, 0, 3, 1, 1, 1};
    const hyst_chain empty = {0, NULL};
    for (size_t i = 0; i < COUNT(stages); ++i) {
        CHECK(hyst_stage_state_length(&stages[i]) == expected[i]);
    }
    CHECK(hyst_chain_state_length(&chain) == state_length);
    CHECK(hyst_chain_state_length(&empty) == 0);
}

/* By hand, for two inputs: u = 3, then -1.
 * affine:   4.25;                 -1.75
 * map:      4.25 + 0.5 2.75 = 5.625;   -1.75
 * PI:       plays 5.375, 4.625, 2.625, y = 4.21875 + 2.6875 + 1.15625 + 0.328125 = 8.390625;
 *           plays -1.5, -0.75, 1.25,   y = -1.3125 - 0.75 - 0.1875 + 0.15625 = -2.09375
 * play:     7.890625;             -1.59375
 * stop:     play 1.890625, y = 6; play 1.890625 (rests in [-7.6, 4.4]), y = -3.484375
 * by direction, thresholds 0 and 1.5, weights 1 and 0.5: 6 + 0.5 4.5 = 8.25;
 *           falling below -1.5: -3.484375 + 0.5 (-3.484375 + 1.5) = -4.4765625 */
static void follows_hand_calculation(void)
{
    hyst_real state[state_length] = {R(0.0)};
    CHECK_EQUAL(hyst_chain_step(&chain, state, R(3.0)), R(8.25));
    CHECK_EQUAL(hyst_chain_step(&chain, state, R(-1.0)), R(-4.4765625));
    const hyst_real expected[] = {R(-1.5),     R(-0.75),    R(1.25),
                                  R(-1.59375), R(1.890625), R(-3.484375)};
    CHECK_SAME_BITS(state, expected, state_length);
}

/* The chain against the operators themselves, called one after the other. */
static void chain_is_its_stages_one_after_the_other(void)
{
    hyst_real state[state_length] = {R(0.0)}, z[3] = {R(0.0)};
    hyst_real z_play = R(0.0), z_stop = R(0.0), u_previous = R(0.0);
    for (size_t k = 0; k < samples; ++k) {
        hyst_real v = hyst_affine_step(stages[0].model, u[k]);
        v = hyst_dead_zone_step(stages[1].model, v);
        v = hyst_pi_step(stages[2].model, z, v);
        v = hyst_play_step(R(0.5), &z_play, v);
        v = hyst_stop_step(R(6.0), &z_stop, v);
        v = hyst_direction_dead_zone_step(stages[5].model, &u_previous, v);
        const hyst_real y = hyst_chain_step(&chain, state, u[k]);
        CHECK_SAME_BITS(&y, &v, 1);
    }
}

static void step_by_step(hyst_real *state, const hyst_real *input, hyst_real *y, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        y[k] = hyst_chain_step(&chain, state, input[k]);
    }
}

static void record_is_its_samples(void)
{
    static hyst_real y[samples], y_steps[samples];
    hyst_real state[state_length] = {R(0.0)}, state_steps[state_length] = {R(0.0)};
    hyst_chain_run(&chain, state, u, y, samples);
    step_by_step(state_steps, u, y_steps, samples);
    CHECK_SAME_BITS(y, y_steps, samples);
    CHECK_SAME_BITS(state, state_steps, state_length);
}

static void record_may_be_overwritten_by_its_output(void)
{
    static hyst_real y[samples], in_place[samples];
    hyst_real state[state_length] = {R(0.0)}, state_in_place[state_length] = {R(0.0)};
    memcpy(in_place, u, sizeof in_place);
    hyst_chain_run(&chain, state, u, y, samples);
    hyst_chain_run(&chain, state_in_place, in_place, in_place, samples);
    CHECK_SAME_BITS(in_place, y, samples);
    CHECK_SAME_BITS(state_in_place, state, state_length);
}

static void input_is_left_alone(void)
{
    static hyst_real before[samples], y[samples];
    hyst_real state[state_length] = {R(0.0)};
    memcpy(before, u, sizeof before);
    hyst_chain_run(&chain, state, u, y, samples);
    CHECK_SAME_BITS(u, before, samples);
}

static void record_in_parts_is_the_whole_record(void)
{
    static hyst_real y[samples], y_parts[samples];
    const size_t cuts[] = {0, 1, 337, samples - 1, samples};
    for (size_t i = 0; i < COUNT(cuts); ++i) {
        const size_t cut = cuts[i];
        hyst_real state[state_length] = {R(0.0)}, state_parts[state_length] = {R(0.0)};
        hyst_chain_run(&chain, state, u, y, samples);
        hyst_chain_run(&chain, state_parts, u, y_parts, cut);
        hyst_chain_run(&chain, state_parts, u + cut, y_parts + cut, samples - cut);
        CHECK_SAME_BITS(y_parts, y, samples);
        CHECK_SAME_BITS(state_parts, state, state_length);
    }
}

static void one_stage_runs_like_its_steps(void)
{
    static hyst_real y[samples];
    for (size_t i = 0; i < COUNT(stages); ++i) {
        hyst_real state[3] = {R(0.0)}, state_steps[3] = {R(0.0)};
        hyst_stage_run(&stages[i], state, u, y, samples);
        for (size_t k = 0; k < samples; ++k) {
            const hyst_real expected = hyst_stage_step(&stages[i], state_steps, u[k]);
            CHECK_SAME_BITS(&y[k], &expected, 1);
        }
        CHECK_SAME_BITS(state, state_steps, 3);
    }
}

static void empty_chain_passes_the_record(void)
{
    static hyst_real y[samples];
    const hyst_chain empty = {0, NULL};
    hyst_chain_run(&empty, NULL, u, y, samples);
    CHECK_SAME_BITS(y, u, samples);
    CHECK_EQUAL(hyst_chain_step(&empty, NULL, R(1.5)), R(1.5));
}

int main(void)
{
    fill_with_noise(u, samples, R(8.0));
    state_is_one_value_a_play_and_one_a_previous_input();
    follows_hand_calculation();
    chain_is_its_stages_one_after_the_other();
    record_is_its_samples();
    record_may_be_overwritten_by_its_output();
    input_is_left_alone();
    record_in_parts_is_the_whole_record();
    one_stage_runs_like_its_steps();
    empty_chain_passes_the_record();
    return check_result();
}
