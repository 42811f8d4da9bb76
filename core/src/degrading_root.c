/* Where a branch of Bouc-Wen's model that degrades comes to what is sought. */
#include "hyst/degrading_branch.h"

#define DEGRADING_STEPS 60u

/* A step this small is the last: the next would be its square. */
#ifdef HYST_SINGLE
#define DEGRADING_NEAR HYST_REAL(1e-5)
#else
#define DEGRADING_NEAR HYST_REAL(1e-10)
#endif

hyst_real hyst_degrading_root(const hyst_degrading *of, hyst_degrading_point at, hyst_real by_way,
                              hyst_real target, hyst_real far)
{
    const hyst_real zero = HYST_REAL(0.0);
    hyst_real low = zero, high = far;
    if (!(target > at.share)) {
        return zero;
    }
    hyst_real x = (target - at.share) / (by_way + hyst_degrading_slope(of, at).share);
    for (size_t left = DEGRADING_STEPS; left > 0u; --left) {
        if (!(x >= low && x <= high)) {
            x = low + HYST_REAL(0.5) * (high - low);
        }
        const hyst_degrading_point there = hyst_degrading_advance(of, at, x);
        const hyst_real miss = by_way * x + there.share - target;
        if (miss > zero) {
            high = x;
        } else {
            low = x;
        }
        const hyst_real change = miss / (by_way + hyst_degrading_slope(of, there).share);
        x = x - change;
        if (change <= DEGRADING_NEAR * x && change >= -DEGRADING_NEAR * x) {
            break;
        }
    }
    return x < zero ? zero : HYST_SELECT(x < far, x, far);
}
