/* Composition of stages. A record passes stage after stage, not sample after sample: the
 * operations on every sample are the same, so both ways give the same bits. */
#include "hyst/chain.h"

#include "hyst/play.h"

size_t hyst_stage_state_length(const hyst_stage *stage)
{
    switch (stage->kind) {
    case HYST_PLAY:
    case HYST_STOP:
    case HYST_DIRECTION_DEAD_ZONE:
        return 1;
    case HYST_PI:
        return stage->as.pi.count;
    case HYST_RATE_DEPENDENT_PI:
        return stage->as.rate_dependent_pi.pi.count + 2u;
    case HYST_STATE_SPACE:
        return stage->as.state_space.order + stage->as.state_space.delay;
    case HYST_SECTIONS:
        return 2u * stage->as.sections.count;
    case HYST_MASING:
        return hyst_masing_state_length(&stage->as.masing);
    case HYST_MEMORY_ELEMENT:
        return 2;
    case HYST_AFFINE:
    case HYST_DEAD_ZONE:
    default:
        return 0;
    }
}

size_t hyst_chain_state_length(const hyst_chain *chain)
{
    size_t length = 0;
    for (size_t i = 0; i < chain->count; ++i) {
        length += hyst_stage_state_length(&chain->stage[i]);
    }
    return length;
}

hyst_real hyst_stage_step(const hyst_stage *stage, hyst_real *state, hyst_real u)
{
    switch (stage->kind) {
    case HYST_AFFINE:
        return stage->as.affine.gain * u + stage->as.affine.offset;
    case HYST_PLAY:
        return hyst_play_step(stage->as.r, state, u);
    case HYST_STOP:
        return hyst_stop_step(stage->as.r, state, u);
    case HYST_DEAD_ZONE:
        return hyst_dead_zone_step(&stage->as.dead_zone, u);
    case HYST_DIRECTION_DEAD_ZONE:
        return hyst_direction_dead_zone_step(&stage->as.dead_zone, state, u);
    case HYST_PI:
        return hyst_pi_step(&stage->as.pi, state, u);
    case HYST_RATE_DEPENDENT_PI:
        return hyst_rate_dependent_pi_step(&stage->as.rate_dependent_pi, state, u);
    case HYST_STATE_SPACE:
        return hyst_state_space_step(&stage->as.state_space, state, u);
    case HYST_SECTIONS:
        return hyst_sections_step(&stage->as.sections, state, u);
    case HYST_MASING:
        return hyst_masing_step(&stage->as.masing, state, u);
    case HYST_MEMORY_ELEMENT:
        return hyst_memory_element_step(&stage->as.memory_element, state, u);
    default:
        return u;
    }
}

hyst_real hyst_chain_step(const hyst_chain *chain, hyst_real *state, hyst_real u)
{
    for (size_t i = 0; i < chain->count; ++i) {
        u = hyst_stage_step(&chain->stage[i], state, u);
        state += hyst_stage_state_length(&chain->stage[i]);
    }
    return u;
}

void hyst_stage_run(const hyst_stage *stage, hyst_real *state, const hyst_real *u, hyst_real *y,
                    size_t samples)
{
    for (size_t k = 0; k < samples; ++k) {
        y[k] = hyst_stage_step(stage, state, u[k]);
    }
}

void hyst_chain_run(const hyst_chain *chain, hyst_real *state, const hyst_real *u, hyst_real *y,
                    size_t samples)
{
    for (size_t k = 0; k < samples && y != u; ++k) {
        y[k] = u[k];
    }
    for (size_t i = 0; i < chain->count; ++i) {
        hyst_stage_run(&chain->stage[i], state, y, y, samples);
        state += hyst_stage_state_length(&chain->stage[i]);
    }
}
