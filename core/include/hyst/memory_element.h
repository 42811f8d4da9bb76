/* Memory element (S3 eqs. 4-6) and its inverse (S3 eqs. 19-20):
 *   y = M(p) u,   u = y / M(p),   dp/dt = g(u) with g(u) = u or |u|,
 * where p may be set back whenever u, and with it y, changes its sign.
 *
 * The input is held between samples, so p_{k+1} = p_k + dt g(u_k) is exact, and since p_k depends on
 * earlier inputs alone the inverse is exact too.
 *
 *   power law    M(p) = c1 + c2 |p|^c3
 *   polynomial   M(p) = a_0 + a_1 p + .. + a_n p^n
 *   table        M linear between the points (knot_j, value_j), constant beyond them */
#ifndef HYST_MEMORY_ELEMENT_H
#define HYST_MEMORY_ELEMENT_H

#include "hyst/kind.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef enum { HYST_MEMORY_POWER, HYST_MEMORY_POLYNOMIAL, HYST_MEMORY_TABLE } hyst_memory_kind;

typedef struct {
    hyst_memory_kind kind;
    size_t count;           /* constants of the polynomial, points of the table; 3 for the power */
    const hyst_real *knot;  /* of the table, strictly ascending */
    const hyst_real *value; /* of the table; a_0 .. a_n; c1, c2, c3 */
} hyst_memory_function;

typedef struct {
    hyst_memory_function function;
    int inverse;       /* 0: y from u, 1: u from y */
    int absolute;      /* 0: g(u) = u, 1: g(u) = |u| */
    int is_reset;      /* 1: p = reset_to where the sign changes */
    hyst_real reset_to;
    hyst_real dt; /* > 0 */
} hyst_memory_element;

/* M(p), which must be positive. */
hyst_real hyst_memory_value(const hyst_memory_function *function, hyst_real p);

/* The state holds p and the sign of the last input that was not zero, 0 before the first. */
hyst_real hyst_memory_element_step(const hyst_memory_element *model, hyst_real *state,
                                   hyst_real input);

extern const hyst_kind hyst_memory_element_kind; /* of a hyst_memory_element */

#ifdef HYST_EXTERN_C
}
#endif

#endif
