/* Constants that follow a slow second signal s, as temperature or bias: straight lines between knots.
 *
 *   c(s) = a + (s - s_i) / (s_{i+1} - s_i) (b - a),   a, b: the constants at the knots s_i <= s < s_{i+1}
 *
 * Outside the knots the constants are held at the nearer end. Where a and b are the same number, c is
 * that number to the bit, and at a knot the constants are those of the knot. What is zero or more at
 * both knots is so between them, whatever rounding does. */
#ifndef HYST_SCHEDULE_H
#define HYST_SCHEDULE_H

#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    size_t knots;         /* at least 1 */
    size_t count;         /* constants of a knot */
    const hyst_real *at;  /* the knots, ascending */
    const hyst_real *row; /* the constants, knot after knot */
} hyst_schedule;

/* Writes the count constants at s. Gives 0, or 1 where s lies outside the knots and they are held. */
int hyst_schedule_constants(const hyst_schedule *schedule, hyst_real s, hyst_real *constants);

#ifdef HYST_EXTERN_C
}
#endif

#endif
