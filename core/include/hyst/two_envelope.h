/* Generalized plays with another envelope for rising than for falling input, and their inverse.
 *
 *     z_i = max(up(u) - r_i, min(down(u) + r_i, z_i)),   y = p0 (up(u) + down(u)) / 2 + sum_i p_i z_i
 *
 * M. Al Janaideh, S. Rakheja, C.-Y. Su, A generalized Prandtl-Ishlinskii model for characterizing
 * the hysteresis and saturation nonlinearities of smart actuators, Smart Mater. Struct. 18 (2009)
 * 045001; there the part without memory is p0 u. Here it is the mean of the envelopes, so that it
 * saturates as they do, and so that equal envelopes give p0 up(u) and the model behind one envelope
 * to the bit.
 *
 * up and down are dead-zone maps that nowhere fall, with down(u) - up(u) + 2 r_i >= 0 for every u and
 * i; p, p0 >= 0; r ascends. Both maps are 0 at 0: a constant that sets them apart is part of r.
 *
 * Inverse. From a given state y(u) is, on either side of the last u, a sum of maxima (minima) of
 * piecewise linear maps; it rises strictly if p0 > 0 and the mean of the envelopes does. A search by
 * halving finds the two knots of the envelopes that u is between; there the plays join in the order
 * of r, and u follows in closed form. With K knots and n plays: at most log2(K) + 2 evaluations of the
 * branch, of n + 2 K terms each, then n + 1 divisions.
 *
 * State: z_1 .. z_n, all 0 at first; of the inverse then u and y of the last sample and the slope of y
 * over u there. */
#ifndef HYST_TWO_ENVELOPE_H
#define HYST_TWO_ENVELOPE_H

#include "hyst/dead_zone.h"
#include "hyst/kind.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    size_t count;          /* number of plays */
    hyst_real p0;          /* weight of the mean of the envelopes */
    const hyst_real *p;    /* weights of the plays */
    const hyst_real *r;    /* their thresholds, ascending */
    hyst_dead_zone up;     /* the envelope of rising input */
    hyst_dead_zone down;   /* the envelope of falling input */
    size_t knots;          /* >= 1 */
    const hyst_real *knot; /* 0 and the thresholds of both envelopes, ascending; for the inverse */
    int inverse;           /* whether the input is the output of the model */
} hyst_two_envelope;

/* One sample. An inverse that overflows answers what is not finite and keeps its state. */
hyst_real hyst_two_envelope_step(const hyst_two_envelope *model, hyst_real *state, hyst_real input);

extern const hyst_kind hyst_two_envelope_kind;

#ifdef HYST_EXTERN_C
}
#endif

#endif
