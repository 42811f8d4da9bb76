/* The way along a piece of a Coleman-Hodgdon branch, from the change of the output. */
#include "hyst/coleman_hodgdon.h"
#include "hyst/power.h"

/* Below this x the exponential is summed, since 1 - exp(-x) loses digits of x. */
#define COLEMAN_SMALL HYST_REAL(0.25)
#define COLEMAN_LOG2_E HYST_REAL(1.4426950408889634)

hyst_real hyst_coleman_share(hyst_real x)
{
    if (x < COLEMAN_SMALL) {
        hyst_real sum = HYST_REAL(1.0);
        for (size_t k = 13; k > 1u; --k) {
            sum = HYST_REAL(1.0) - sum * x / (hyst_real)k;
        }
        return x * sum;
    }
    return HYST_REAL(1.0) - hyst_exp2(-COLEMAN_LOG2_E * x);
}

/* From which Newton's steps go one way only: above the solution where the slope rises, bend < 0, and
 * below it where it falls. */
static hyst_real coleman_start(hyst_real line, hyst_real bend, hyst_real w)
{
    const hyst_real first = line + bend; /* the slope at 0 */
    const hyst_real by_slope = w / first;
    const hyst_real by_end = (w - bend) / line; /* 1 - exp(-x) is no more than 1 */
    if (!(bend < HYST_REAL(0.0))) {
        return by_slope > by_end ? by_slope : by_end;
    }
    hyst_real start = by_slope < by_end ? by_slope : by_end;
    /* x - x^2/2 + x^3/6 >= 1 - exp(-x) leaves first x - bend x^2 / 3 <= w up to x = 1. */
    const hyst_real third = HYST_REAL(-0.3333333333333333) * bend;
    const hyst_real root = hyst_power(first * first + HYST_REAL(4.0) * third * w, HYST_REAL(0.5));
    const hyst_real by_square = HYST_REAL(2.0) * w / (first + root);
    if (by_square <= HYST_REAL(1.0) && by_square < start) {
        start = by_square;
    }
    return start;
}

hyst_real hyst_coleman_way(hyst_real line, hyst_real bend, hyst_real w)
{
    hyst_real x;
    if (!(w > HYST_REAL(0.0))) {
        return HYST_REAL(0.0);
    }
    x = coleman_start(line, bend, w);
    for (size_t left = HYST_COLEMAN_LIMIT; left > 0u; --left) {
        const hyst_real share = hyst_coleman_share(x);
        const hyst_real miss = line * x + bend * share - w;
        const hyst_real next = x - miss / (line + bend * (HYST_REAL(1.0) - share));
        /* A step the other way, or none, is rounding. */
        if (bend < HYST_REAL(0.0) ? !(next < x) : !(next > x)) {
            break;
        }
        x = next;
    }
    return x > HYST_REAL(0.0) ? x : HYST_REAL(0.0);
}
