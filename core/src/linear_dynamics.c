/* Sampled linear dynamics, one sample at a time. */
#include "hyst/linear_dynamics.h"

#include "hyst/finite.h"

/* Put u at the end of the delay line. Handed on from end to start, because a compiler would turn a
 * shift from start to end into a call of memmove, which a target need not have. */
static void push(hyst_real *line, size_t delay, hyst_real u)
{
    for (size_t i = delay; i > 0u; --i) {
        const hyst_real held = line[i - 1u];
        line[i - 1u] = u;
        u = held;
    }
}

hyst_real hyst_state_space_step(const hyst_state_space *system, hyst_real *state, hyst_real u)
{
    const size_t n = system->order;
    hyst_real next[HYST_LARGEST_ORDER];
    const hyst_real w = system->delay == 0u ? u : state[n];
    hyst_real y = system->d * w;
    for (size_t i = 0; i < n; ++i) {
        next[i] = system->b[i] * w;
    }
    /* Column after column: the sums of all rows run side by side. */
    for (size_t j = 0; j < n; ++j) {
        const hyst_real x = state[j];
        const hyst_real *column = system->a + j * n;
        y += system->c[j] * x;
        for (size_t i = 0; i < n; ++i) {
            next[i] += column[i] * x;
        }
    }
    hyst_real zero = HYST_REAL(0.0); /* unless a next state is not finite: then NaN */
    for (size_t i = 0; i < n; ++i) {
        zero += next[i] - next[i];
    }
    const int finite = hyst_is_finite(zero);
    for (size_t i = 0; i < n; ++i) {
        state[i] = finite ? next[i] : state[i];
    }
    if (!finite) {
        return zero;
    }
    push(state + n, system->delay, u);
    return y;
}

hyst_real hyst_sections_step(const hyst_sections *sections, hyst_real *state, hyst_real u)
{
    const hyst_real *section = sections->coefficient;
    for (size_t i = 0; i < sections->count; ++i, section += 5, state += 2) {
        const hyst_real y = section[0] * u + state[0];
        const hyst_real first = section[1] * u - section[3] * y + state[1];
        const hyst_real second = section[2] * u - section[4] * y;
        if (!hyst_is_finite(first) || !hyst_is_finite(second)) {
            return (first - first) + (second - second);
        }
        state[0] = first;
        state[1] = second;
        u = y;
    }
    return u;
}

static size_t state_space_length(const void *model)
{
    const hyst_state_space *system = (const hyst_state_space *)model;
    return system->order + system->delay;
}

static hyst_real state_space_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_state_space_step((const hyst_state_space *)model, state, u);
}

const hyst_kind hyst_state_space_kind = {state_space_length, state_space_step};

static size_t sections_length(const void *model)
{
    return 2u * ((const hyst_sections *)model)->count;
}

static hyst_real sections_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_sections_step((const hyst_sections *)model, state, u);
}

const hyst_kind hyst_sections_kind = {sections_length, sections_step};
