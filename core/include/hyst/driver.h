/* A driver that is commanded in whole codes: the volts of a code, and the code whose volts are nearest.
 *
 * Between the points of its table volts are a straight line in the code,
 *   volt(c) = V_i + s_i (c - C_i),   C_i <= c < C_(i+1),
 * never beyond V_(i+1), which rounding alone could do; the last point is V_(count-1) itself. Two points
 * are a scale and an offset. Volts of neighbouring codes must differ by some roundings, which whoever
 * fills the structure makes sure of: the search for a code is then as short as it looks. */
#ifndef HYST_DRIVER_H
#define HYST_DRIVER_H

#include <stdint.h>

#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    size_t count;           /* points, 2 or more */
    const int32_t *code;    /* C_i, strictly rising */
    const hyst_real *volt;  /* V_i, all strictly rising or all strictly falling */
    const hyst_real *slope; /* s_i of the count - 1 pieces, volts a code */
    int32_t lowest;         /* the codes that may be given, within the table */
    int32_t highest;
} hyst_driver;

/* The volts of a code; of one beyond the table those of its end. */
hyst_real hyst_driver_volt(const hyst_driver *driver, int32_t code);

/* The code from lowest to highest whose volts are nearest, of two that are as near the lower one. What
 * is not a number gives one of those codes; that it is none is for the caller to find. */
int32_t hyst_driver_code(const hyst_driver *driver, hyst_real volt);

#ifdef HYST_EXTERN_C
}
#endif

#endif
