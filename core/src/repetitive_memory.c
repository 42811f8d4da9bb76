/* Memory of a repetitive controller, one sample at a time. In a file of its own, so that code that
 * calls the stages of its inverse directly needs no chain. */
#include "hyst/repetitive_memory.h"

#include "hyst/finite.h"

#define REPETITIVE_PLACE 0u     /* of this sample in the ring of N + h */
#define REPETITIVE_OF_ERROR 1u  /* of this sample among the last errors */
#define REPETITIVE_WHOLE 2u     /* samples since the start; after a lost one, as of a later start */
#define REPETITIVE_COMPARED 3u  /* references in a row that were there, up to N */
#define REPETITIVE_OF_PERIOD 4u /* of this sample in the period */
#define REPETITIVE_RING 5u

/* A count below `end`, whatever the state holds. */
static size_t repetitive_count(hyst_real value, size_t end)
{
    return value > HYST_REAL(0.0) && value < (hyst_real)end ? (size_t)value : 0u;
}

/* i + by in a ring; both are at most its length. */
static size_t repetitive_onwards(size_t i, size_t by, size_t length)
{
    const size_t there = i + by;
    return there < length ? there : there - length;
}

size_t hyst_repetitive_memory_length(const hyst_repetitive_memory *memory)
{
    return REPETITIVE_RING + memory->period + memory->half + 2u * memory->taps +
           (memory->compares != 0 ? memory->period : 0u);
}

void hyst_repetitive_forget(const hyst_repetitive_memory *memory, hyst_real *state)
{
    const size_t length = hyst_repetitive_memory_length(memory);
    for (size_t i = 0; i < length; ++i) {
        state[i] = HYST_REAL(0.0);
    }
}

/* Whether the reference is another one than a period ago; it is kept. */
static int repetitive_compare(const hyst_repetitive_memory *memory, hyst_real *state, hyst_real y_ref)
{
    const size_t n = memory->period, at = repetitive_count(state[REPETITIVE_OF_PERIOD], n);
    hyst_real *const kept = state + REPETITIVE_RING + n + memory->half + 2u * memory->taps + at;
    int changed = 0;
    if (hyst_is_finite(y_ref) != 0) {
        const hyst_real away = y_ref - *kept;
        changed = state[REPETITIVE_COMPARED] >= (hyst_real)n &&
                  !(away <= memory->tolerance && -away <= memory->tolerance);
        *kept = y_ref;
        if (state[REPETITIVE_COMPARED] < (hyst_real)n) {
            state[REPETITIVE_COMPARED] += HYST_REAL(1.0);
        }
    } else if (state[REPETITIVE_COMPARED] < (hyst_real)n) {
        state[REPETITIVE_COMPARED] = HYST_REAL(0.0);
    }
    state[REPETITIVE_OF_PERIOD] = (hyst_real)repetitive_onwards(at, 1u, n);
    return changed;
}

/* w_k: what is remembered of a period ago, through Q. */
static hyst_real repetitive_smoothed(const hyst_repetitive_memory *memory, const hyst_real *ring,
                                     size_t place)
{
    const size_t h = memory->half, length = memory->period + h;
    size_t before = repetitive_onwards(place, h, length), behind = before;
    hyst_real w = memory->smooth[0] * ring[before];
    for (size_t j = 1; j <= h; ++j) {
        before = before > 0u ? before - 1u : length - 1u;
        behind = behind + 1u < length ? behind + 1u : 0u;
        w += memory->smooth[j] * (ring[before] + ring[behind]);
    }
    return w;
}

/* Samples that must have been there before one teaches. */
static hyst_real repetitive_enough(const hyst_repetitive_memory *memory)
{
    return (hyst_real)(memory->wait + memory->lead + 1u);
}

/* Counts samples; after one that is lost, as many as L sees must come again. */
static void repetitive_wait(const hyst_repetitive_memory *memory, hyst_real *count, int there)
{
    const hyst_real enough = repetitive_enough(memory), again = enough - (hyst_real)memory->taps;
    if (there == 0) {
        *count = *count > again ? again : *count;
    } else if (*count < enough) {
        *count += HYST_REAL(1.0);
    }
}

hyst_real hyst_repetitive_wanted(const hyst_repetitive_memory *memory, hyst_real *state,
                                 hyst_real y_ref, hyst_real y, int *changed)
{
    if (memory->compares != 0 && repetitive_compare(memory, state, y_ref) != 0) {
        hyst_repetitive_forget(memory, state);
        (void)repetitive_compare(memory, state, y_ref);
        *changed = 1;
    }
    const size_t length = memory->period + memory->half;
    const size_t place = repetitive_count(state[REPETITIVE_PLACE], length);
    const size_t of_error = repetitive_count(state[REPETITIVE_OF_ERROR], memory->taps);
    const hyst_real e = y_ref - y;
    const hyst_real w = repetitive_smoothed(memory, state + REPETITIVE_RING, place);
    const int there = hyst_is_finite(e);
    state[REPETITIVE_RING + length + of_error] = there != 0 ? e : HYST_REAL(0.0);
    state[REPETITIVE_RING + place] = hyst_is_finite(w) != 0 ? w : HYST_REAL(0.0);
    repetitive_wait(memory, state + REPETITIVE_WHOLE, there);
    return there != 0 ? y_ref + w : e - e;
}

/* sum_j L_j e_{k+j} of k = now - lead, the oldest error first. */
static hyst_real repetitive_lesson(const hyst_repetitive_memory *memory, const hyst_real *error,
                                   size_t now)
{
    hyst_real sum = HYST_REAL(0.0);
    size_t at = now;
    for (size_t i = 0; i < memory->taps; ++i) {
        at = repetitive_onwards(at, 1u, memory->taps);
        sum += memory->learn[i] * error[at];
    }
    return sum;
}

void hyst_repetitive_learn(const hyst_repetitive_memory *memory, hyst_real *state, hyst_real excess)
{
    const size_t length = memory->period + memory->half, taps = memory->taps;
    hyst_real *const ring = state + REPETITIVE_RING, *const error = ring + length;
    hyst_real *const held = error + taps; /* what each drive could not do, beside its error */
    const size_t place = repetitive_count(state[REPETITIVE_PLACE], length);
    const size_t of_error = repetitive_count(state[REPETITIVE_OF_ERROR], taps);
    /* What was wanted stays, though less was applied: with that in its place, a drive that lags by its
     * rate would ask for the lag, and lag behind it again a period later. */
    held[of_error] = hyst_is_finite(excess) != 0 ? excess : HYST_REAL(0.0);
    if (state[REPETITIVE_WHOLE] >= repetitive_enough(memory)) {
        const size_t at = repetitive_onwards(place, length - memory->lead, length);
        const hyst_real past = held[repetitive_onwards(of_error, taps - memory->lead, taps)];
        const hyst_real more = repetitive_lesson(memory, error, of_error), next = ring[at] + more;
        const int further = (past < HYST_REAL(0.0) && more > HYST_REAL(0.0)) ||
                            (past > HYST_REAL(0.0) && more < HYST_REAL(0.0));
        if (further == 0 && hyst_is_finite(next) != 0) {
            ring[at] = next;
        }
    }
    state[REPETITIVE_PLACE] = (hyst_real)repetitive_onwards(place, 1u, length);
    state[REPETITIVE_OF_ERROR] = (hyst_real)repetitive_onwards(of_error, 1u, taps);
}
