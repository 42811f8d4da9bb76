/* Dahl's model of friction before sliding, and its inverse.
 *
 *     dF/du = sigma |1 - s F / Fc|^n sgn(1 - s F / Fc),   s = sgn(du)
 *
 * P. R. Dahl, A solid friction model, Aerospace Corporation TOR-0158(3107-18)-1 (1968), and Solid
 * friction damping of mechanical vibrations, AIAA Journal 14 (1976) 1675-1682.
 *
 * With z = F / Fc, w = 1 - s z >= 0, a = sigma / Fc and m = n - 1 the solution over a way x = a |du|
 * without a turn is exact:
 *
 *     w' = w exp(-L),   L = ln(1 + m t) / m,   t = x w^m    (L = x for m = 0),
 *
 * and back, x = w^-m (exp(m L) - 1) / m with L = ln(w / w'). So a sample costs a logarithm and two
 * exponentials at most. The way is taken from where the branch began, at the last turn: samples in
 * between change no bit, and ways that are small beside the digits of z add up.
 *
 * State: position u and force z of the last sample, and both where the branch began. */
#ifndef HYST_DAHL_H
#define HYST_DAHL_H

#include "hyst/kind.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    hyst_real force;  /* Fc */
    hyst_real rate;   /* a = sigma / Fc, per input unit */
    hyst_real excess; /* m = n - 1 */
    int inverse;      /* whether the input is the force */
} hyst_dahl;

/* One sample. The inverse answers a force of Fc or more, which no way reaches, by what is not
 * finite, and keeps its state. */
hyst_real hyst_dahl_step(const hyst_dahl *model, hyst_real *state, hyst_real input);

extern const hyst_kind hyst_dahl_kind;

#ifdef HYST_EXTERN_C
}
#endif

#endif
