/* Where a stretch of a Jiles-Atherton branch comes to what is sought. */
#include "hyst/jiles_atherton.h"

/* A step this small is the last: the next would be its square, or a part in 1e9 of it. */
#ifdef HYST_SINGLE
#define JILES_NEAR HYST_REAL(1e-5)
#define JILES_NEARER HYST_REAL(1e-2)
#else
#define JILES_NEAR HYST_REAL(3e-11)
#define JILES_NEARER HYST_REAL(1e-5)
#endif

static hyst_real jiles_size(hyst_real x)
{
    return x < HYST_REAL(0.0) ? -x : x;
}

hyst_real hyst_jiles_root(const hyst_jiles_stretch *on, hyst_real target, hyst_real low,
                          hyst_real at_low, hyst_real high, hyst_real at_high)
{
    if (!(at_low < target)) {
        return low;
    }
    if (!(at_high > target)) {
        return high;
    }
    /* Beside a root no step says that the next would be its square. */
    const hyst_real near = on->excess > HYST_REAL(0.0) ? JILES_NEARER * JILES_NEAR : JILES_NEAR;
    hyst_real x = low + (high - low) * ((target - at_low) / (at_high - at_low));
    for (size_t left = HYST_JILES_LIMIT; left > 0u; --left) {
        hyst_real slope;
        const hyst_real miss = hyst_jiles_sought(on, x, &slope) - target;
        if (miss > HYST_REAL(0.0)) {
            high = x;
        } else {
            low = x;
        }
        hyst_real next = x - miss / slope;
        if (!(next >= low && next <= high)) {
            next = low + HYST_REAL(0.5) * (high - low);
        }
        const hyst_real step = jiles_size(next - x);
        x = next;
        if (step <= near * (HYST_REAL(1.0) + jiles_size(x))) {
            break;
        }
    }
    return x;
}
