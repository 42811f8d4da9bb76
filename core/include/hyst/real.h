/* The number type of the whole core: double, or float when HYST_SINGLE is defined.
 * One source serves both; a program links one of the two, never a mixture.
 *
 * C++ may put another one in their place, say one that carries derivatives: HYST_REAL_HEADER names its
 * header. The functions then are others, so their names are not those of C. */
#ifndef HYST_REAL_H
#define HYST_REAL_H

#include <stddef.h>

#ifdef HYST_REAL_HEADER
#include HYST_REAL_HEADER
#else

#ifdef __cplusplus
#define HYST_EXTERN_C
#endif

#ifdef HYST_SINGLE
typedef float hyst_real;
#define HYST_REAL(literal) literal##f
#else
typedef double hyst_real;
#define HYST_REAL(literal) literal
#endif

/* a or b; a macro, so that C compiles what stands there. */
#define HYST_SELECT(condition, a, b) ((condition) ? (a) : (b))

/* A number that rounding alone tells from the exact one: where numbers carry derivatives, it has those
 * of the exact one. */
#define HYST_ROUNDED(exact, rounded) (rounded)

#endif

#endif
