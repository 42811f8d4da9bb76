/* The Langevin function. */
#include "hyst/langevin.h"

#include "hyst/power.h"

/* Below this size the continued fraction, above it the exponential. */
#define LANGEVIN_SMALL HYST_REAL(1.5)
/* -2 log2(e) */
#define LANGEVIN_MINUS_TWO_LOG2_E HYST_REAL(-2.8853900817779268)
#ifdef HYST_SINGLE
#define LANGEVIN_LAST HYST_REAL(0.9999999)
#else
#define LANGEVIN_LAST HYST_REAL(0.9999999999999998)
#endif

static hyst_real langevin_size(hyst_real x)
{
    return x < HYST_REAL(0.0) ? -x : x;
}

/* L(x) / x = 1 / (3 + x^2 / (5 + x^2 / (7 + ..))), Lambert's fraction of coth. */
static hyst_real langevin_over_x(hyst_real x)
{
    const hyst_real square = x * x;
    hyst_real below = HYST_REAL(23.0);
    for (size_t k = 10; k > 0u; --k) {
        below = (hyst_real)(2u * k + 1u) + square / below;
    }
    return HYST_REAL(1.0) / below;
}

hyst_real hyst_langevin(hyst_real x)
{
    const hyst_real size = langevin_size(x);
    if (size < LANGEVIN_SMALL) {
        return x * langevin_over_x(x);
    }
    const hyst_real q = hyst_exp2(LANGEVIN_MINUS_TWO_LOG2_E * size);
    const hyst_real one = HYST_REAL(1.0);
    const hyst_real value = (one + q) / (one - q) - one / size;
    return x < HYST_REAL(0.0) ? -value : value;
}

hyst_real hyst_langevin_slope(hyst_real x)
{
    const hyst_real size = langevin_size(x);
    const hyst_real one = HYST_REAL(1.0);
    if (size < LANGEVIN_SMALL) {
        /* L' = 1 - L^2 - 2 L / x, by the equation that coth satisfies. */
        const hyst_real ratio = langevin_over_x(x);
        const hyst_real value = x * ratio;
        return one - value * value - HYST_REAL(2.0) * ratio;
    }
    const hyst_real q = hyst_exp2(LANGEVIN_MINUS_TWO_LOG2_E * size);
    return one / (size * size) - HYST_REAL(4.0) * q / ((one - q) * (one - q));
}

hyst_real hyst_langevin_inverse(hyst_real v)
{
    hyst_real size = langevin_size(v);
    hyst_real x;
    if (!(size < LANGEVIN_LAST)) {
        size = LANGEVIN_LAST;
    }
    /* Cohen's approximation, within 5 % everywhere and exact at both ends. */
    x = size * (HYST_REAL(3.0) - size * size) / ((HYST_REAL(1.0) - size) * (HYST_REAL(1.0) + size));
    for (size_t left = HYST_LANGEVIN_LIMIT; left > 0u; --left) {
        const hyst_real step = (hyst_langevin(x) - size) / hyst_langevin_slope(x);
        const hyst_real next = x - step;
        if (!(next < x) && !(next > x)) {
            break;
        }
        x = next > HYST_REAL(0.0) ? next : HYST_REAL(0.5) * x;
    }
    return v < HYST_REAL(0.0) ? -x : x;
}
