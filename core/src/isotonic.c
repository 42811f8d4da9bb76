/* Pool adjacent violators. Pools are runs of equal values, so they need no memory of their own: two
 * pools that happen to be equal may count as one. */
#include "hyst/isotonic.h"

#include "hyst/play.h"

/* Added to a gain, so that a gain of 0 weighs more than any other instead of dividing by it. */
#define LEAST_GAIN HYST_REAL(1e-30)

static hyst_real weight_of(const hyst_real *gain, size_t i)
{
    return gain != NULL ? HYST_REAL(1.0) / (gain[i] + LEAST_GAIN) : HYST_REAL(1.0);
}

static void pool(hyst_real *x, const hyst_real *gain, size_t last)
{
    size_t first = last;
    hyst_real mean = x[last];
    hyst_real weight = weight_of(gain, last);
    while (first > 0u && x[first - 1u] > mean) {
        const hyst_real level = x[first - 1u];
        hyst_real more = HYST_REAL(0.0);
        while (first > 0u && !(x[first - 1u] < level || x[first - 1u] > level)) {
            --first;
            more += weight_of(gain, first);
        }
        weight += more;
        mean += more / weight * (level - mean);
    }
    for (size_t i = first; i <= last; ++i) {
        x[i] = mean;
    }
}

void hyst_isotonic_weighted(size_t count, hyst_real *x, const hyst_real *gain, hyst_real lower,
                            hyst_real upper)
{
    for (size_t i = 1; i < count; ++i) {
        if (x[i - 1u] > x[i]) {
            pool(x, gain, i);
        }
    }
    for (size_t i = 0; i < count; ++i) {
        x[i] = hyst_clamp(lower, upper, x[i]);
    }
}

void hyst_isotonic(size_t count, hyst_real *x, hyst_real lower, hyst_real upper)
{
    hyst_isotonic_weighted(count, x, NULL, lower, upper);
}
