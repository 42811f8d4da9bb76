/* Constants over a second signal. */
#include "hyst/schedule.h"

static void held(const hyst_schedule *schedule, size_t knot, hyst_real *constants)
{
    const hyst_real *row = schedule->row + knot * schedule->count;
    for (size_t i = 0; i < schedule->count; ++i) {
        constants[i] = row[i];
    }
}

int hyst_schedule_constants(const hyst_schedule *schedule, hyst_real s, hyst_real *constants)
{
    const hyst_real *at = schedule->at;
    const size_t count = schedule->count;
    size_t knot = 0;
    while (knot + 1u < schedule->knots && s >= at[knot + 1u]) {
        ++knot;
    }
    if (knot + 1u < schedule->knots && s > at[knot]) {
        const hyst_real *low = schedule->row + knot * count;
        const hyst_real *high = low + count;
        const hyst_real share = (s - at[knot]) / (at[knot + 1u] - at[knot]);
        for (size_t i = 0; i < count; ++i) {
            constants[i] = low[i] + share * (high[i] - low[i]);
        }
    } else {
        held(schedule, knot, constants);
    }
    return s < at[0] || s > at[schedule->knots - 1u];
}
