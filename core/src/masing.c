/* Loading curve with memory of reversals, one sample at a time.
 *
 * Invariant: the reversals on the stack alternate and every one lies between the two before it, the
 * first two between the first and its mirror image. Nothing is written below `count` before the
 * output is known to be finite. */
#include "hyst/masing.h"

#include "hyst/finite.h"

typedef struct {
    hyst_real input;
    hyst_real output;
} point;

static const point origin = {HYST_REAL(0.0), HYST_REAL(0.0)};

static point point_at(const hyst_real *state, size_t index)
{
    const hyst_real *place = state + HYST_MASING_STACK + 2u * index;
    const point kept = {place[0], place[1]};
    return kept;
}

static void keep(hyst_real *state, size_t index, point reversal)
{
    hyst_real *place = state + HYST_MASING_STACK + 2u * index;
    place[0] = reversal.input;
    place[1] = reversal.output;
}

size_t hyst_masing_state_length(const hyst_masing *model)
{
    return HYST_MASING_STACK + 2u * model->depth;
}

size_t hyst_masing_reversals(const hyst_masing *model, const hyst_real *state)
{
    const hyst_real count = state[HYST_MASING_COUNT];
    if (!(count > HYST_REAL(0.0))) {
        return 0;
    }
    return count < (hyst_real)model->depth ? (size_t)count : model->depth;
}

hyst_real hyst_masing_curve(const hyst_masing *model, hyst_real x)
{
    return model->inverse ? hyst_unloading(&model->curve, x) : hyst_loading(&model->curve, x);
}

/* Output on the branch that starts at a reversal, or on the loading curve where there is none. */
static hyst_real branch(const hyst_masing *model, int has_start, point start, hyst_real input)
{
    /* Halved before the difference, which cannot overflow then. */
    const hyst_real along = has_start ? HYST_REAL(0.5) * input - HYST_REAL(0.5) * start.input : input;
    const hyst_real twice = has_start ? HYST_REAL(2.0) : HYST_REAL(1.0);
    if (along < HYST_REAL(0.0)) {
        return start.output - twice * hyst_masing_curve(model, -along);
    }
    return start.output + twice * hyst_masing_curve(model, along);
}

/* The same curve the other way: the input of a model that the inverse has as its output. */
static hyst_real back(const hyst_masing *model, int has_start, point start, hyst_real output)
{
    hyst_masing other = *model;
    const point exchanged = {start.output, start.input};
    other.inverse = !model->inverse;
    return branch(&other, has_start, exchanged, output);
}

static int reached(int rising, hyst_real input, hyst_real limit)
{
    return rising ? input >= limit : input <= limit;
}

/* Rounding must not move the output against the input. */
static hyst_real not_against(int rising, hyst_real output, hyst_real last)
{
    return reached(rising, output, last) ? output : last;
}

/* Reversals left when the input has come this far: a loop that is closed takes two with it. */
static size_t left_open(const hyst_real *state, size_t count, int rising, hyst_real input)
{
    while (count >= 2u && reached(rising, input, point_at(state, count - 2u).input)) {
        count -= 2u;
    }
    if (count == 1u && reached(rising, input, -point_at(state, 0u).input)) {
        count = 0;
    }
    return count;
}

/* A branch ends where it closes its loop; rounding must not carry it beyond. Where a curve is flat it
 * is as far before: then the output is the branch's own, and so is what numbers with derivatives
 * carry beside it. */
static hyst_real within_loop(const hyst_real *state, size_t count, int rising, hyst_real output)
{
    hyst_real limit;
    if (count == 0u) {
        return output;
    }
    limit = count >= 2u ? point_at(state, count - 2u).output : -point_at(state, 0u).output;
    return (rising ? output > limit : output < limit) ? limit : output;
}

/* What was kept beyond the last reversal leaves no trace, so that equal memories are equal bits. */
static void forget(hyst_real *state, size_t first, size_t end)
{
    for (size_t i = first; i < end; ++i) {
        keep(state, i, origin);
    }
}

static hyst_real nested(const hyst_masing *model, hyst_real *state, hyst_real input)
{
    const point last = {state[HYST_MASING_INPUT], state[HYST_MASING_OUTPUT]};
    const int rising = input > last.input;
    size_t count = hyst_masing_reversals(model, state);
    const point start = count > 0u ? point_at(state, count - 1u) : origin;
    const int has_moved = last.input > start.input || last.input < start.input;
    const int turns = has_moved && (last.input > start.input) != rising;
    const int is_full = turns && count == model->depth;
    const int goes_back = is_full && !reached(rising, input, start.input);
    const size_t kept = turns && !is_full ? count + 1u : count;
    hyst_real output;
    if (is_full && !goes_back) {
        --count;
    } else if (turns && !is_full) {
        keep(state, count, last);
        ++count;
    }
    if (!goes_back) {
        count = left_open(state, count, rising, input);
    }
    output = branch(model, count > 0u, count > 0u ? point_at(state, count - 1u) : origin, input);
    if (!hyst_is_finite(output)) {
        forget(state, hyst_masing_reversals(model, state), kept);
        return output;
    }
    output = goes_back ? output : within_loop(state, count, rising, output);
    forget(state, count, kept);
    state[HYST_MASING_INPUT] = input;
    state[HYST_MASING_OUTPUT] = output;
    state[HYST_MASING_COUNT] = (hyst_real)count;
    if (is_full) {
        state[HYST_MASING_OVERFLOW] = HYST_REAL(1.0);
    }
    return output;
}

/* Where a branch starts after the input has gone back from the extreme: 1 and the start, or 0 while
 * it is still within the dead band. */
static int turned(const hyst_masing *model, int has_start, point start, point extreme, int rising,
                  hyst_real input, point *new_start)
{
    const hyst_real back_by = rising ? -model->dead_band : model->dead_band;
    *new_start = extreme;
    if (!(model->dead_band > HYST_REAL(0.0))) {
        return 1;
    }
    if (model->inverse) {
        new_start->output = extreme.output - back_by;
        new_start->input = back(model, has_start, start, new_start->output);
    } else {
        new_start->input = extreme.input - back_by;
        new_start->output = branch(model, has_start, start, new_start->input);
    }
    return rising ? input > new_start->input : input < new_start->input;
}

static hyst_real of_last_reversal(const hyst_masing *model, hyst_real *state, hyst_real input)
{
    const point extreme = {state[HYST_MASING_INPUT], state[HYST_MASING_OUTPUT]};
    const int has_start = hyst_masing_reversals(model, state) > 0;
    const point start = has_start ? point_at(state, 0) : origin;
    const int has_moved = extreme.input > start.input || extreme.input < start.input;
    const int rising = input > extreme.input;
    const int goes_back = has_moved && (extreme.input > start.input) != rising;
    point new_start;
    hyst_real output;
    if (!goes_back) {
        output = branch(model, has_start, start, input);
        if (hyst_is_finite(output)) {
            output = not_against(rising, output, extreme.output);
            state[HYST_MASING_INPUT] = input;
            state[HYST_MASING_OUTPUT] = output;
        }
        return output;
    }
    if (!turned(model, has_start, start, extreme, rising, input, &new_start)) {
        return branch(model, has_start, start, input);
    }
    output = branch(model, 1, new_start, input);
    if (!hyst_is_finite(output) || (output >= extreme.output && output <= extreme.output)) {
        return output;
    }
    keep(state, 0, new_start);
    state[HYST_MASING_INPUT] = input;
    state[HYST_MASING_OUTPUT] = output;
    state[HYST_MASING_COUNT] = HYST_REAL(1.0);
    return output;
}

hyst_real hyst_masing_step(const hyst_masing *model, hyst_real *state, hyst_real input)
{
    const hyst_real last = state[HYST_MASING_INPUT];
    if (input <= last && input >= last) {
        return state[HYST_MASING_OUTPUT];
    }
    return model->last_reversal ? of_last_reversal(model, state, input)
                                : nested(model, state, input);
}
