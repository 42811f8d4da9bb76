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

/* The drive nearest to u that may be, and the new *last. The limits hold whatever *last is. u must be
 * finite. */
hyst_real hyst_limited_drive(const hyst_drive_limits *limits, hyst_real *last, hyst_real u);

#ifdef HYST_EXTERN_C
}
#endif

#endif
