/* What a drive may be: within its limits, and no farther from the last one than it can move. */
#ifndef HYST_DRIVE_LIMITS_H
#define HYST_DRIVE_LIMITS_H

#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    hyst_real low, high; /* low <= high; the largest numbers there are for none */
    hyst_real change;    /* from one sample to the next, > 0; or 0 for any */
} hyst_drive_limits;

static inline hyst_real hyst_drive_between(hyst_real u, hyst_real low, hyst_real high)
{
    const hyst_real above = u < low ? low : u;
    return above > high ? high : above;
}

/* The drive nearest to u that may be, after the drive `last`. */
static inline hyst_real hyst_allowed_drive(const hyst_drive_limits *limits, hyst_real last,
                                           hyst_real u)
{
    if (limits->change > HYST_REAL(0.0)) {
        u = hyst_drive_between(u, last - limits->change, last + limits->change);
    }
    return hyst_drive_between(u, limits->low, limits->high);
}

/* The same, and the new *last. The limits hold whatever *last is. u must be finite. */
hyst_real hyst_limited_drive(const hyst_drive_limits *limits, hyst_real *last, hyst_real u);

#ifdef HYST_EXTERN_C
}
#endif

#endif
