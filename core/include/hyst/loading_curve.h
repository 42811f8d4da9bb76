/* Initial loading curves of operators with Masing memory: f(0) = 0, increasing on x >= 0.
 *
 *   power law    f(x) = linear x + factor x^exponent                 (S3 eqs. 2-3)
 *   plays        f(x) = value_j + slope_j (x - knot_j) for knot_j <= x < knot_{j+1}, knot_0 = 0:
 *                the curve of a discrete Prandtl-Ishlinskii operator, or a table
 *   polynomial   f(x) = a_1 x + .. + a_n x^n
 *
 * The inverse takes at most HYST_POWER_LIMIT power evaluations for a power law with an exponent
 * above 1, one more below 1 (the same equation for x^exponent); a search of the knots for plays;
 * HYST_POLYNOMIAL_LIMIT evaluations for a polynomial. */
#ifndef HYST_LOADING_CURVE_H
#define HYST_LOADING_CURVE_H

#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

#define HYST_POWER_LIMIT 6
#define HYST_POLYNOMIAL_LIMIT 100

typedef enum { HYST_POWER_LAW, HYST_PLAYS, HYST_POLYNOMIAL } hyst_curve_kind;

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
    hyst_curve_kind kind;
    union {
        hyst_power_law power_law;
        hyst_pieces pieces;
        hyst_polynomial polynomial;
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
