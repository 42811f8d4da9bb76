/* A polynomial of an input and of what its hysteresis has made of it:
 *
 *     y = sum over i + j <= n of c_ij u^i z^j
 *
 * With the polarization for z it is the strain of a ferroelectric, y = Q z^2 + d z u + ..: a butterfly.
 * W. P. Mason, Electrostrictive effect in barium titanate ceramics, Phys. Rev. 74 (1948) 1134;
 * A. F. Devonshire, Theory of ferroelectrics, Adv. Phys. 3 (1954) 85-130. */
#ifndef HYST_STATE_POLYNOMIAL_H
#define HYST_STATE_POLYNOMIAL_H

#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    size_t degree;                /* n */
    const hyst_real *coefficient; /* c_00 .. c_0n, c_10 .. c_1(n-1), .., c_n0 */
} hyst_state_polynomial;

/* By Horner's scheme, in z within and in u around it. */
hyst_real hyst_state_polynomial_value(const hyst_state_polynomial *map, hyst_real u, hyst_real z);

#ifdef HYST_EXTERN_C
}
#endif

#endif
