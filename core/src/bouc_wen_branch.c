/* Ways and shares along a branch of Bouc-Wen's model. */
#include "hyst/bouc_wen_branch.h"

#include "hyst/power.h"
#include "hyst/small_steps.h"

#ifdef HYST_SINGLE
#define BOUC_WEN_ENOUGH 1e-4f /* of a step of Newton's: its square is lost */
#define BOUC_WEN_NOTHING 1e-9f
#define BOUC_WEN_COARSE 2u
#define BOUC_WEN_LAST 18.0f /* exp(-this) is no part of 1 */
#else
#define BOUC_WEN_ENOUGH 1e-9
#define BOUC_WEN_NOTHING 1e-18
#define BOUC_WEN_COARSE 1u
#define BOUC_WEN_LAST 40.0
#endif

/* Above, the series at the limit; below, the continued fraction. */
#define BOUC_WEN_NEAR HYST_REAL(0.75)

static hyst_real bouc_wen_least(hyst_real a, hyst_real b)
{
    return HYST_SELECT(a < b, a, b);
}

static hyst_real bouc_wen_most(hyst_real a, hyst_real b)
{
    return HYST_SELECT(a > b, a, b);
}

/* The continued fraction from its end, where what it is made of has no number. */
static hyst_real bouc_wen_deep_fraction(hyst_real n, hyst_real w)
{
    const hyst_real one = HYST_REAL(1.0);
    size_t half = 74u / BOUC_WEN_COARSE;
    for (hyst_real bound = HYST_REAL(-64.0); w < bound && bound > -HYST_BOUC_WEN_RATIO;
         bound = HYST_REAL(4.0) * bound) {
        half = 2u * half;
    }
    hyst_real tail = one;
    for (size_t k = half; k > 0u; --k) {
        const hyst_real whole = n * (hyst_real)k;
        const hyst_real twice = one + HYST_REAL(2.0) * whole;
        const hyst_real odd = one + whole;
        tail = one - w * (odd * odd) / (twice * (twice + n) * tail);
        tail = one - w * (whole * whole) / ((twice - n) * twice * tail);
    }
    return one / (one - w / ((one + n) * tail));
}

typedef struct {
    hyst_real least, most;
    size_t half;
} bouc_wen_depth;

/* Half the partial quotients that leave less than an epsilon, for -16 <= w <= 3/4. */
static size_t bouc_wen_half_depth(hyst_real w)
{
    static const bouc_wen_depth row[] = {{HYST_REAL(-0.03125), HYST_REAL(0.03125), 4},
               {HYST_REAL(-0.125), HYST_REAL(0.125), 6},
               {HYST_REAL(-0.5), HYST_REAL(0.25), 8},
               {HYST_REAL(-1.0), HYST_REAL(0.5), 12},
               {HYST_REAL(-4.0), HYST_REAL(0.75), 19}};
    for (size_t i = 0; i < sizeof row / sizeof row[0]; ++i) {
        if (w >= row[i].least && w <= row[i].most) {
            return row[i].half / BOUC_WEN_COARSE;
        }
    }
    return 37u / BOUC_WEN_COARSE;
}

/* 2F1(1, 1/n; 1 + 1/n; w) for w <= 3/4, from below 0 too. */
static hyst_real bouc_wen_fraction(hyst_real n, hyst_real w)
{
    const hyst_real one = HYST_REAL(1.0);
    if (w < HYST_REAL(-16.0)) {
        return bouc_wen_deep_fraction(n, w);
    }
    /* Forwards, numerators and denominators apart: no division waits for another. */
    hyst_real below = one + (-w / (one + n)), below_last = one;
    hyst_real above = one, above_last = one;
    const size_t half = bouc_wen_half_depth(w);
    for (size_t k = 1; k <= half; ++k) {
        const hyst_real whole = n * (hyst_real)k;
        const hyst_real twice = one + HYST_REAL(2.0) * whole;
        const hyst_real odd = one + whole;
        const hyst_real even_part = -w * (whole * whole / ((twice - n) * twice));
        const hyst_real odd_part = -w * (odd * odd / (twice * (twice + n)));
        below_last = below + even_part * below_last;
        above_last = above + even_part * above_last;
        below = below_last + odd_part * below;
        above = above_last + odd_part * above;
    }
    return above / below;
}

/* (-ln q - sum_k c_k q^k / k) / n. */
static hyst_real bouc_wen_limit_series(hyst_real n, hyst_real q)
{
    const hyst_real b = HYST_REAL(1.0) / n;
    hyst_real factor = HYST_REAL(1.0), power = HYST_REAL(1.0);
    hyst_real sum = HYST_NATURAL_OF_2 * hyst_log2(q);
    /* Ended by the power: a factor that is 0, as of n = 1, has a derivative. */
    for (size_t k = 1; k <= 60u; ++k) {
        const hyst_real j = (hyst_real)k;
        factor = factor * ((j - b) / j);
        power = power * q;
        sum = sum + factor * power / j;
        if (power < BOUC_WEN_NOTHING && j > b) {
            break;
        }
    }
    return -sum / n;
}

hyst_real hyst_bouc_wen_join(hyst_real n)
{
    const hyst_real share = hyst_power(BOUC_WEN_NEAR, HYST_REAL(1.0) / n);
    return share * bouc_wen_fraction(n, BOUC_WEN_NEAR) -
           bouc_wen_limit_series(n, HYST_REAL(1.0) - BOUC_WEN_NEAR);
}

/* The rising way, and q = 1 - share^n; left = 1 - share is known to more digits near the limit. */
static hyst_real bouc_wen_rise(hyst_real n, hyst_real join, hyst_real share, hyst_real left,
                               hyst_real *q)
{
    const hyst_real one = HYST_REAL(1.0);
    if (!(share > HYST_REAL(0.0))) {
        *q = one;
        return share;
    }
    hyst_real logarithm;
    if (left < HYST_REAL(0.5)) {
        logarithm = hyst_small_logarithm(one, -left);
    } else {
        logarithm = HYST_NATURAL_OF_2 * hyst_log2(share);
    }
    *q = -hyst_small_exponential(one, n * logarithm);
    if (*q < one - BOUC_WEN_NEAR) {
        return bouc_wen_limit_series(n, *q) + join;
    }
    return share * bouc_wen_fraction(n, one - *q);
}

/* For n = 1 the ways are logarithms. */
static hyst_real bouc_wen_rise_quickly(hyst_real n, hyst_real join, hyst_real share, hyst_real left,
                                       hyst_real *q)
{
    if (n == HYST_REAL(1.0)) {
        *q = left;
        /* Next to the limit the share is 1, which has no logarithm of what is left. */
        if (left < HYST_REAL(0.5)) {
            return -HYST_NATURAL_OF_2 * hyst_log2(left);
        }
        return -hyst_small_logarithm(n, -share);
    }
    return bouc_wen_rise(n, join, share, left, q);
}

hyst_real hyst_bouc_wen_rising(hyst_real n, hyst_real join, hyst_real share)
{
    hyst_real q;
    return bouc_wen_rise_quickly(n, join, share, HYST_REAL(1.0) - share, &q);
}

static hyst_real bouc_wen_fall(hyst_real n, hyst_real ratio, hyst_real share)
{
    return share * bouc_wen_fraction(n, -ratio * hyst_power(share, n));
}

hyst_real hyst_bouc_wen_falling(hyst_real n, hyst_real ratio, hyst_real share)
{
    if (n == HYST_REAL(1.0)) {
        return hyst_small_logarithm(ratio, share);
    }
    return bouc_wen_fall(n, ratio, share);
}

/* -ln(1 - share) of a rising way, about: on the side from which Newton's steps do not overshoot. */
static hyst_real bouc_wen_guess(hyst_real n, hyst_real join, hyst_real way)
{
    const hyst_real far = n * (way - join) + HYST_NATURAL_OF_2 * hyst_log2(n);
    return n > HYST_REAL(1.0) ? bouc_wen_most(way, far) : bouc_wen_least(way, far);
}

hyst_real hyst_bouc_wen_risen(hyst_real n, hyst_real join, hyst_real tilt, hyst_real from,
                              hyst_real way)
{
    const hyst_real one = HYST_REAL(1.0), zero = HYST_REAL(0.0);
    if (!(from < one)) {
        return from;
    }
    const hyst_real whole = hyst_bouc_wen_rising(n, join, from) + tilt * from + way;
    const hyst_real last = BOUC_WEN_LAST;
    const hyst_real tilt_most = bouc_wen_most(tilt, zero), tilt_least = bouc_wen_least(tilt, zero);
    if (!(whole > zero)) {
        return zero;
    }
    hyst_real low = (whole - tilt_most) * bouc_wen_least(one, n);
    hyst_real high = (whole - tilt_least) * bouc_wen_most(one, n);
    low = bouc_wen_most(low, zero);
    if (low > last) {
        return one;
    }
    high = bouc_wen_least(high, HYST_REAL(2.0) * last);
    hyst_real x = bouc_wen_guess(n, join, whole / (one + tilt));
    x = bouc_wen_guess(n, join, whole + tilt * hyst_small_exponential(one, -bouc_wen_most(x, zero)));
    for (int step = 0; step < HYST_BOUC_WEN_STEPS; ++step) {
        if (!(x >= low && x <= high)) {
            x = HYST_REAL(0.5) * (low + high);
        }
        hyst_real q;
        const hyst_real share = -hyst_small_exponential(one, -x);
        const hyst_real left = hyst_exp2(-HYST_BINARY_OF_E * x);
        const hyst_real excess =
            bouc_wen_rise_quickly(n, join, share, left, &q) + tilt * share - whole;
        if (excess > zero) {
            high = x;
        } else {
            low = x;
        }
        const hyst_real change = excess / (left / q + tilt * left);
        x = x - change;
        if (change <= BOUC_WEN_ENOUGH * x && change >= -BOUC_WEN_ENOUGH * x) {
            break;
        }
    }
    return -hyst_small_exponential(one, -x);
}

hyst_real hyst_bouc_wen_fallen(hyst_real n, hyst_real ratio, hyst_real tilt, hyst_real from,
                               hyst_real way)
{
    const hyst_real one = HYST_REAL(1.0);
    const hyst_real whole = hyst_bouc_wen_falling(n, ratio, from) + tilt * from - way;
    const hyst_real steep = one / (one + ratio * hyst_power(from, n)) + tilt;
    hyst_real x = bouc_wen_most(whole / (one + tilt), from - way / steep);
    for (int step = 0; step < HYST_BOUC_WEN_STEPS; ++step) {
        if (!(x > HYST_REAL(0.0))) {
            return HYST_REAL(0.0);
        }
        const hyst_real lack = whole - hyst_bouc_wen_falling(n, ratio, x) - tilt * x;
        const hyst_real change = lack / (one / (one + ratio * hyst_power(x, n)) + tilt);
        x = x + change;
        if (change <= BOUC_WEN_ENOUGH * x && change >= -BOUC_WEN_ENOUGH * x) {
            break;
        }
    }
    return bouc_wen_least(x, from);
}
