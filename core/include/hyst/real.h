/* The number type of the whole core: double, or float when HYST_SINGLE is defined.
 * One source serves both; a program links one of the two, never a mixture. */
#ifndef HYST_REAL_H
#define HYST_REAL_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#ifdef HYST_SINGLE
typedef float hyst_real;
#define HYST_REAL(literal) literal##f
#else
typedef double hyst_real;
#define HYST_REAL(literal) literal
#endif

#ifdef __cplusplus
}
#endif

#endif
