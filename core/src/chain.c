/* Composition of stages. A record passes stage after stage, not sample after sample: the
 * operations on every sample are the same, so both ways give the same bits. */
#include "hyst/chain.h"

size_t hyst_stage_state_length(const hyst_stage *stage)
{
    return stage->kind->length(stage->model);
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
    return stage->kind->step(stage->model, state, u);
}

hyst_real hyst_chain_step(const hyst_chain *chain, hyst_real *state, hyst_real u)
{
    for (size_t i = 0; i < chain->count; ++i) {
        if (i > 0u) {
            state += hyst_stage_state_length(&chain->stage[i - 1u]);
        }
        u = hyst_stage_step(&chain->stage[i], state, u);
    }
    return u;
}

void hyst_stage_run(const hyst_stage *stage, hyst_real *state, const hyst_real *u, hyst_real *y,
                    size_t samples)
{
    /* Looked up once: what is written to y could be the row, as far as a compiler knows. */
    const hyst_stage own = *stage;
    const hyst_kind kind = *own.kind;
    for (size_t k = 0; k < samples; ++k) {
        y[k] = kind.step(own.model, state, u[k]);
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
