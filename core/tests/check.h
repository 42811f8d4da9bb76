/* Checks for the tests of the core. A failed check prints where and what, and the program goes on;
 * main ends with `return check_result();`, which is not 0 if anything failed.
 *
 * The same tests are compiled for double and for float. EXPECTED_REAL_SIZE comes from the build, so
 * that a variant which is not what its name says fails. */
#ifndef CHECK_H
#define CHECK_H

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "hyst/hyst.h"

#define R(literal) HYST_REAL(literal)
#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

#ifdef HYST_SINGLE
#define REAL_MAX FLT_MAX
#define REAL_EPSILON FLT_EPSILON
#else
#define REAL_MAX DBL_MAX
#define REAL_EPSILON DBL_EPSILON
#endif

static int check_failures = 0;

static inline void check_failed(const char *file, int line, const char *what)
{
    ++check_failures;
    fprintf(stderr, "%s:%d: %s\n", file, line, what);
}

/* Equal in value: for numbers that can be calculated by hand without rounding. */
static inline void check_equal(const char *file, int line, const char *what, hyst_real actual,
                               hyst_real expected)
{
    if (!(actual == expected)) {
        check_failed(file, line, what);
        fprintf(stderr, "    is %.17g, expected %.17g\n", (double)actual, (double)expected);
    }
}

static inline void check_near(const char *file, int line, const char *what, double actual,
                              double expected, double tolerance)
{
    if (!(fabs(actual - expected) <= tolerance)) {
        check_failed(file, line, what);
        fprintf(stderr, "    is %.17g, expected %.17g, differs by %.3g, allowed %.3g\n", actual,
                expected, actual - expected, tolerance);
    }
}

/* Equal to the bit: for two ways that must be the same calculation. */
static inline void check_same_bits(const char *file, int line, const char *what,
                                   const hyst_real *actual, const hyst_real *expected, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        if (memcmp(&actual[k], &expected[k], sizeof(hyst_real)) != 0) {
            check_failed(file, line, what);
            fprintf(stderr, "    at %lu: is %.17g, expected %.17g\n", (unsigned long)k,
                    (double)actual[k], (double)expected[k]);
            return;
        }
    }
}

#define CHECK(condition) \
    do { \
        if (!(condition)) { \
            check_failed(__FILE__, __LINE__, #condition); \
        } \
    } while (0)
#define CHECK_EQUAL(actual, expected) \
    check_equal(__FILE__, __LINE__, #actual " == " #expected, actual, expected)
#define CHECK_NEAR(actual, expected, tolerance) \
    check_near(__FILE__, __LINE__, #actual " near " #expected, actual, expected, tolerance)
#define CHECK_SAME_BITS(actual, expected, count) \
    check_same_bits(__FILE__, __LINE__, #actual " same bits as " #expected, actual, expected, count)

/* Repeatable numbers in [-amplitude, amplitude): 24 random bits, so float holds them exactly. */
static inline void fill_with_noise(hyst_real *signal, size_t count, hyst_real amplitude)
{
    uint32_t bits = 1u;
    for (size_t k = 0; k < count; ++k) {
        bits = 1664525u * bits + 1013904223u;
        signal[k] = amplitude * ((hyst_real)(bits >> 8) / R(8388608.0) - R(1.0));
    }
}

static inline int check_result(void)
{
    CHECK(sizeof(hyst_real) == EXPECTED_REAL_SIZE);
    if (check_failures != 0) {
        fprintf(stderr, "%d checks failed\n", check_failures);
    }
    return check_failures != 0;
}

#endif
