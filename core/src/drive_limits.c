/* Limits of a drive and of its rate. In a file of its own, so that code that calls the stages of its
 * inverse directly needs no chain. */
#include "hyst/drive_limits.h"

static hyst_real drive_between(hyst_real u, hyst_real low, hyst_real high)
{
    const hyst_real above = u < low ? low : u;
    return above > high ? high : above;
}

hyst_real hyst_limited_drive(const hyst_drive_limits *limits, hyst_real *last, hyst_real u)
{
    hyst_real drive = u;
    if (limits->change > HYST_REAL(0.0)) {
        drive = drive_between(drive, *last - limits->change, *last + limits->change);
    }
    drive = drive_between(drive, limits->low, limits->high);
    *last = drive;
    return drive;
}
