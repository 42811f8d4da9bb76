/* The Preisach operator and its inverse, one sample at a time.
 *
 * Invariant: the reversals on the stack alternate and every one lies between the two before it, the
 * first two between the first and its mirror image; in inputs, which are outputs for the inverse.
 * Nothing is written below `count` before the output is known to be finite. */
#include "hyst/preisach.h"

#include "hyst/finite.h"

static hyst_preisach_point preisach_kept(const hyst_real *state, size_t index)
{
    const hyst_real *place = state + HYST_PREISACH_STACK + 2u * index;
    const hyst_preisach_point kept = {place[0], place[1]};
    return kept;
}

static void preisach_keep(hyst_real *state, size_t index, hyst_preisach_point reversal)
{
    hyst_real *place = state + HYST_PREISACH_STACK + 2u * index;
    place[0] = reversal.u;
    place[1] = reversal.y;
}

/* What was kept beyond the last reversal leaves no trace, so that equal memories are equal bits. */
static void preisach_forget(hyst_real *state, size_t first, size_t end)
{
    const hyst_preisach_point nothing = {HYST_REAL(0.0), HYST_REAL(0.0)};
    for (size_t i = first; i < end; ++i) {
        preisach_keep(state, i, nothing);
    }
}

size_t hyst_preisach_reversals(const hyst_preisach *model, const hyst_real *state)
{
    const hyst_real count = state[HYST_PREISACH_COUNT];
    if (!(count > HYST_REAL(0.0))) {
        return 0;
    }
    return count < (hyst_real)model->depth ? (size_t)count : model->depth;
}

/* The input of a point, be it u or y. */
static hyst_real preisach_coordinate(const hyst_preisach *model, hyst_preisach_point point)
{
    return model->inverse ? point.y : point.u;
}

static hyst_real preisach_first_output(const hyst_preisach *model, hyst_real u)
{
    const hyst_preisach_piece piece = hyst_preisach_to_input(model, NULL, u);
    return hyst_preisach_output(&piece, u);
}

static hyst_real preisach_answer(const hyst_preisach *model, const hyst_preisach_point *start,
                                 hyst_real input)
{
    const hyst_preisach_piece piece = model->inverse ? hyst_preisach_to_output(model, start, input)
                                                     : hyst_preisach_to_input(model, start, input);
    return model->inverse ? hyst_preisach_input(&piece, input) : hyst_preisach_output(&piece, input);
}

static hyst_real preisach_on_branch(const hyst_preisach *model, const hyst_real *state, size_t count,
                                    hyst_real input)
{
    hyst_preisach_point start;
    if (count == 0u) {
        return preisach_answer(model, NULL, input);
    }
    start = preisach_kept(state, count - 1u);
    return preisach_answer(model, &start, input);
}

/* Where the loop of the last of `count` reversals closes: the one before it, or the mirror image. */
static hyst_preisach_point preisach_closing(const hyst_preisach *model, const hyst_real *state,
                                            size_t count)
{
    hyst_preisach_point mirror;
    if (count >= 2u) {
        return preisach_kept(state, count - 2u);
    }
    mirror.u = -preisach_kept(state, 0u).u;
    mirror.y = preisach_first_output(model, mirror.u);
    return mirror;
}

/* The last input as a reversal. On the first loading curve the initial state is not the kernel's own,
 * so the curve is asked again. */
static hyst_preisach_point preisach_reversal(const hyst_preisach *model, const hyst_real *state,
                                             size_t count)
{
    const hyst_real input = state[HYST_PREISACH_INPUT], output = state[HYST_PREISACH_OUTPUT];
    hyst_preisach_point point = {input, output};
    if (model->inverse != 0) {
        point.u = output;
        point.y = input;
        if (count == 0u) {
            point.y = HYST_ROUNDED(preisach_first_output(model, output), input);
        }
        return point;
    }
    if (count == 0u) {
        point.y = preisach_first_output(model, input);
    }
    return point;
}

static int preisach_reached(int rising, hyst_real input, hyst_real limit)
{
    return rising ? input >= limit : input <= limit;
}

/* Reversals left when the input has come this far: a loop that is closed takes two with it. */
static size_t preisach_left_open(const hyst_preisach *model, const hyst_real *state, size_t count,
                                 int rising, hyst_real input)
{
    while (count >= 2u &&
           preisach_reached(rising, input,
                            preisach_coordinate(model, preisach_kept(state, count - 2u)))) {
        count -= 2u;
    }
    if (count == 1u &&
        preisach_reached(rising, input,
                         preisach_coordinate(model, preisach_closing(model, state, 1u)))) {
        count = 0;
    }
    return count;
}

/* A branch ends where it closes its loop; rounding must not carry it beyond. */
static hyst_real preisach_within_loop(const hyst_preisach *model, const hyst_real *state, size_t count,
                                      int rising, hyst_real output)
{
    hyst_preisach_point end;
    hyst_real limit;
    if (count == 0u) {
        return output;
    }
    end = preisach_closing(model, state, count);
    limit = model->inverse ? end.u : end.y;
    return preisach_reached(rising, output, limit) ? HYST_ROUNDED(output, limit) : output;
}

hyst_real hyst_preisach_step(const hyst_preisach *model, hyst_real *state, hyst_real input)
{
    const hyst_real last = state[HYST_PREISACH_INPUT];
    const size_t before = hyst_preisach_reversals(model, state);
    const hyst_preisach_point origin = {HYST_REAL(0.0), model->rising[1]};
    const hyst_real start =
        preisach_coordinate(model, before > 0u ? preisach_kept(state, before - 1u) : origin);
    const int has_moved = last > start || last < start;
    const int has_risen = last > start;
    const int rests = !(input > last) && !(input < last);
    const int rising = input > last || (rests && has_risen);
    const int turns = has_moved && ((has_risen && !rising) || (rising && !has_risen));
    const int is_full = turns && before == model->depth;
    const int goes_back = is_full && !preisach_reached(rising, input, start);
    const size_t kept = turns && !is_full ? before + 1u : before;
    size_t count = is_full && !goes_back ? before - 1u : kept;
    hyst_real output;
    if (turns && !is_full) {
        preisach_keep(state, before, preisach_reversal(model, state, before));
    }
    if (!goes_back && !rests) {
        count = preisach_left_open(model, state, count, rising, input);
    }
    output = preisach_on_branch(model, state, count, input);
    if (!hyst_is_finite(output)) {
        preisach_forget(state, before, kept);
        return output;
    }
    if (!goes_back) {
        output = preisach_within_loop(model, state, count, rising, output);
    }
    preisach_forget(state, count, kept);
    state[HYST_PREISACH_INPUT] = input;
    state[HYST_PREISACH_OUTPUT] = output;
    state[HYST_PREISACH_COUNT] = (hyst_real)count;
    if (is_full != 0) {
        state[HYST_PREISACH_OVERFLOW] = HYST_REAL(1.0);
    }
    return output;
}

static size_t preisach_length(const void *model)
{
    return HYST_PREISACH_STACK + 2u * ((const hyst_preisach *)model)->depth;
}

static hyst_real preisach_step(const void *model, hyst_real *state, hyst_real u)
{
    return hyst_preisach_step((const hyst_preisach *)model, state, u);
}

const hyst_kind hyst_preisach_kind = {preisach_length, preisach_step};
