/* Initial loading curves of operators with Masing memory: f(0) = 0, increasing on x >= 0.
 *
 *   power law    f(x) = linear x + factor x^exponent                 (S3 eqs. 2-3)
 *   plays        f(x) = value_j + slope_j (x - knot_j) for knot_j <= x < knot_{j+1}, knot_0 = 0:
 *                the curve of a discrete Prandtl-Ishlinskii operator, or a table
 *   polynomial   f(x) = a_1 x + .. + a_n x^n
 *   exponential  f(x) = c x - d b (1 - exp(-x / b)): the slope goes from c - d to c
 *   iwan         f(x) = (K_T + K_inf) x - q x^(chi + 2) up to the way of macro-slip, and from there on
 *                F_S + K_inf x: Jenkins elements in parallel whose ways to slip are spread by a power
 *                law (D. J. Segalman, A four-parameter Iwan model for lap-type joints, J. Appl. Mech.
 *                72 (2005) 752-760); chi = 0 without a last element is W. D. Iwan's uniform spread
 *                (A distributed-element model for hysteresis, J. Appl. Mech. 33 (1966) 893-900)
 *
 * The inverse takes at most HYST_POWER_LIMIT power evaluations for a power law with an exponent
 * above 1, one more below 1 (the same equation for x^exponent); a search of the knots for plays;
 * HYST_POLYNOMIAL_LIMIT evaluations for a polynomial; HYST_EXPONENTIAL_LIMIT times three
 * exponentials or logarithms; HYST_IWAN_LIMIT powers. What lies beyond a curve that saturates has an infinity. */
#ifndef HYST_LOADING_CURVE_H
#define HYST_LOADING_CURVE_H

#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

#define HYST_POWER_LIMIT 6
#define HYST_POLYNOMIAL_LIMIT 100
#define HYST_EXPONENTIAL_LIMIT 12
#define HYST_IWAN_LIMIT 40

typedef enum {
    HYST_POWER_LAW,
    HYST_PLAYS,
    HYST_POLYNOMIAL,
    HYST_EXPONENTIAL,
    HYST_IWAN
} hyst_curve_kind;

typedef struct {
    hyst_real linear;   /* >= 0 */
    hyst_real factor;   /* >= 0, not both zero */
    hyst_real exponent; /* > 0, not 1 */
} hyst_power_law;

typedef struct {
    size_t count;           /* >= 1 pieces */
    const hyst_real *knot;  /* ascending from 0 */
    const hyst_real *value; /* f at the knots */
    const hyst_real *slope; /* >= 0; > 0 for the inverse */
} hyst_pieces;

typedef struct {
    size_t count;                 /* >= 1 */
    const hyst_real *coefficient; /* a_1 .. a_count */
    hyst_real least_slope;        /* > 0: f' is nowhere below it on x >= 0 */
} hyst_polynomial;

typedef struct {
    hyst_real first;  /* slope at 0, c - d >= 0 */
    hyst_real last;   /* slope far out, c >= 0, not both zero */
    hyst_real change; /* d = last - first */
    hyst_real way;    /* b > 0 */
} hyst_exponential;

typedef struct {
    hyst_real stiffness; /* K_T + K_inf > 0 */
    hyst_real factor;    /* q >= 0 */
    hyst_real exponent;  /* chi + 2 > 1 */
    hyst_real limit;     /* way at which the last element slips, > 0 */
    hyst_real force;     /* F_S, of all elements that slip */
    hyst_real residual;  /* K_inf >= 0 */
} hyst_iwan;

typedef struct {
    hyst_curve_kind kind;
    union {
        hyst_power_law power_law;
        hyst_pieces pieces;
        hyst_polynomial polynomial;
        hyst_exponential exponential;
        hyst_iwan iwan;
    } as;
} hyst_loading_curve;

/* f(x) for x >= 0, and the x >= 0 with f(x) = w for w >= 0. */
hyst_real hyst_loading(const hyst_loading_curve *curve, hyst_real x);
hyst_real hyst_unloading(const hyst_loading_curve *curve, hyst_real w);

/* f'(x) for x >= 0. */
hyst_real hyst_loading_slope(const hyst_loading_curve *curve, hyst_real x);

#ifdef HYST_EXTERN_C
}
#endif

#endif
