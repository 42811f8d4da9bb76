/* Limits of a drive and of its rate. In a file of its own, so that code that calls the stages of its
 * inverse directly needs no chain. */
#include "hyst/drive_limits.h"

hyst_real hyst_limited_drive(const hyst_drive_limits *limits, hyst_real *last, hyst_real u)
{
    const hyst_real drive = hyst_allowed_drive(limits, *last, u);
    *last = drive;
    return drive;
}
