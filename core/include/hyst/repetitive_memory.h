/* What a repetitive controller remembers of a reference that repeats after N samples.
 *
 *   v_k = y_ref,k + w_k,   w_k = sum_j Q_j s_{k-N+j},   s_k = w_k + sum_j L_j e_{k+j},   e = y_ref - y
 *
 * Q, j = -h .. h, is symmetric; L, j = lead - taps + 1 .. lead, is the inverse of the linear plant
 * times a gain. Both look ahead, which a memory of a period can: s_k is there from sample k + lead on,
 * and is asked for at k + N - h at the earliest, so that h + lead < N must hold.
 *
 * The first samples teach nothing: what only a start makes must not be repeated.
 * Where a drive could not do what was wanted, s_k learns nothing that asks for more. Errors of which some are missing teach nothing, but time goes on, so that what is
 * remembered stays in step with the reference.
 *
 * Inoue et al. 1981; Hara et al. 1988, IEEE TAC 33(7) (with Q); Tomizuka et al. 1989, J. Dyn. Sys.
 * Meas. Control 111 (sampled).
 *
 * Cost: h + 1 + taps products and 2 h + taps sums a sample, whatever N is. State: 5 + N + h + 2 taps
 * numbers, and N more where references are compared; all of them 0 at start. */
#ifndef HYST_REPETITIVE_MEMORY_H
#define HYST_REPETITIVE_MEMORY_H

#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    size_t period;           /* N >= 1, at most 2^23: samples are counted in hyst_real */
    size_t half;             /* h, h + lead < N */
    size_t lead;             /* samples that L looks ahead, below taps */
    size_t taps;             /* of L, >= 1 */
    size_t wait;             /* samples at start that teach nothing */
    int compares;            /* whether a reference that changes is told */
    hyst_real tolerance;     /* the most it may differ from that of a period before, >= 0 */
    const hyst_real *smooth; /* h + 1: Q_0 .. Q_h */
    const hyst_real *learn;  /* taps: of the oldest error first */
} hyst_repetitive_memory;

size_t hyst_repetitive_memory_length(const hyst_repetitive_memory *memory);

/* v_k, to be followed by hyst_repetitive_learn. Not finite, as what is wanted is not known, where y_ref
 * or y is not. Where the reference is another one than a period ago, all is forgotten first and
 * *changed becomes 1; else it stays as it is. */
hyst_real hyst_repetitive_wanted(const hyst_repetitive_memory *memory, hyst_real *state,
                                 hyst_real y_ref, hyst_real y, int *changed);

/* Learns, and goes on to the next sample. excess: the v that was applied minus the v wanted. */
void hyst_repetitive_learn(const hyst_repetitive_memory *memory, hyst_real *state,
                           hyst_real excess);

/* Forgets all. */
void hyst_repetitive_forget(const hyst_repetitive_memory *memory, hyst_real *state);

#ifdef HYST_EXTERN_C
}
#endif

#endif
