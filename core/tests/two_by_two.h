/* A Preisach model that can be followed by hand: thresholds -1, 0, 1 and masses
 *
 *     alpha in [0, 1]     2   1
 *     alpha in [-1, 0]    1
 *     beta in      [-1, 0] [0, 1]
 *
 * Demagnetised, y_v(u) = 4 u |u|: up to u the triangle turns, u^2, and half the square, 2 u^2 / 2. */
#ifndef TWO_BY_TWO_H
#define TWO_BY_TWO_H

#include "check.h"

#define DEPTH 4u
#define LENGTH (HYST_PREISACH_STACK + 2u * DEPTH)

static const hyst_real edges[] = {R(-1.0), R(0.0), R(1.0)};
static const hyst_real corners[] = {R(0.0), R(2.0), R(0.0), R(8.0), R(2.0), R(0.0)};
static const hyst_real up[] = {R(0.0), R(0.0), R(0.0), R(4.0), R(1.0), R(4.0), R(0.0), R(0.0)};
static const hyst_real down[] = {R(0.0), R(0.0), R(0.0), R(4.0), R(1.0), R(-4.0), R(0.0), R(0.0)};

static inline hyst_preisach two_by_two(hyst_real p0, int inverse)
{
    const hyst_preisach model = {2, edges, R(1.0), corners, 2, up, 2, down, p0, 0, inverse, DEPTH};
    return model;
}

#endif
