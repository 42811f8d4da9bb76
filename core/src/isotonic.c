/* Pool adjacent violators. Pools are runs of equal values, so they need no memory of their own: two
 * pools that happen to be equal may count as one. */
#include "hyst/isotonic.h"

#include "hyst/play.h"

static size_t run_ending_at(const hyst_real *x, size_t last)
{
    size_t first = last;
    while (first > 0u && !(x[first - 1u] < x[last] || x[first - 1u] > x[last])) {
        --first;
    }
    return last - first + 1u;
}

static void pool(hyst_real *x, size_t last)
{
    size_t first = last;
    hyst_real mean = x[last];
    while (first > 0u && x[first - 1u] > mean) {
        const size_t more = run_ending_at(x, first - 1u);
        const hyst_real share = (hyst_real)more / (hyst_real)(last - first + 1u + more);
        mean += share * (x[first - 1u] - mean);
        first -= more;
    }
    for (size_t i = first; i <= last; ++i) {
        x[i] = mean;
    }
}

void hyst_isotonic(size_t count, hyst_real *x, hyst_real lower, hyst_real upper)
{
    for (size_t i = 1; i < count; ++i) {
        if (x[i - 1u] > x[i]) {
            pool(x, i);
        }
    }
    for (size_t i = 0; i < count; ++i) {
        x[i] = hyst_clamp(lower, upper, x[i]);
    }
}
