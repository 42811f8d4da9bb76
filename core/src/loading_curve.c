/* Loading curves and their inverses. */
#include "hyst/loading_curve.h"

#include "hyst/power.h"

static hyst_real magnitude(hyst_real value)
{
    return value < HYST_REAL(0.0) ? -value : value;
}

/* The last piece that starts at or below x, by halving. */
static size_t piece_at(const hyst_real *start, size_t count, hyst_real x)
{
    size_t low = 0, high = count;
    while (high - low > 1u) {
        const size_t middle = low + (high - low) / 2u;
        if (start[middle] <= x) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

static hyst_real polynomial(const hyst_polynomial *f, hyst_real x)
{
    hyst_real sum = HYST_REAL(0.0);
    for (size_t j = f->count; j > 0u; --j) {
        sum = (sum + f->coefficient[j - 1u]) * x;
    }
    return sum;
}

static hyst_real polynomial_slope(const hyst_polynomial *f, hyst_real x)
{
    hyst_real sum = HYST_REAL(0.0);
    for (size_t j = f->count; j > 0u; --j) {
        sum = sum * x + (hyst_real)j * f->coefficient[j - 1u];
    }
    return sum;
}

hyst_real hyst_loading(const hyst_loading_curve *curve, hyst_real x)
{
    switch (curve->kind) {
    case HYST_PLAYS: {
        const hyst_pieces *f = &curve->as.pieces;
        const size_t j = piece_at(f->knot, f->count, x);
        return f->value[j] + f->slope[j] * (x - f->knot[j]);
    }
    case HYST_POLYNOMIAL:
        return polynomial(&curve->as.polynomial, x);
    case HYST_POWER_LAW:
    default: {
        const hyst_power_law *f = &curve->as.power_law;
        return f->linear * x + f->factor * hyst_power(x, f->exponent);
    }
    }
}

hyst_real hyst_loading_slope(const hyst_loading_curve *curve, hyst_real x)
{
    switch (curve->kind) {
    case HYST_PLAYS: {
        const hyst_pieces *f = &curve->as.pieces;
        return f->slope[piece_at(f->knot, f->count, x)];
    }
    case HYST_POLYNOMIAL:
        return polynomial_slope(&curve->as.polynomial, x);
    case HYST_POWER_LAW:
    default: {
        const hyst_power_law *f = &curve->as.power_law;
        return f->linear +
               f->exponent * f->factor * hyst_power(x, f->exponent - HYST_REAL(1.0));
    }
    }
}

/* One step of Halley's method for a x + b x^e = w, given f(x) = w (1 + excess) and s = b x^(e-1). */
static hyst_real halley(hyst_real a, hyst_real s, hyst_real e, hyst_real x, hyst_real residual)
{
    const hyst_real first = a + e * s;
    const hyst_real second = e * (e - HYST_REAL(1.0)) * s / x;
    return HYST_REAL(2.0) * residual * first /
           (HYST_REAL(2.0) * first * first - residual * second);
}

/* The x > 0 with a x + b x^e = w, for e > 1, a, b >= 0 and w > 0.
 *
 * Both w/a and (w/b)^(1/e) are too large; X, the smaller of them, is at most twice the solution. The
 * left side is convex and increasing, so from X down Halley's steps converge, and there its value is
 * known without another power. Over all a, b and e at most five steps end below 1e-15 of x; each but
 * the first takes one power, and finding X takes one, or two. */
static hyst_real solve_power_law(hyst_real a, hyst_real b, hyst_real e, hyst_real w)
{
    const hyst_real enough = HYST_REAL(1e-5) / e;
    const hyst_real by_line = w / a; /* infinite where a is 0: then the power alone decides */
    const hyst_real by_line_power = b * hyst_power(by_line, e);
    hyst_real x, step;
    int powers = 1;
    if (by_line_power <= w) {
        x = by_line;
        step = halley(a, by_line_power / x, e, x, by_line_power);
    } else {
        x = hyst_power(w / b, HYST_REAL(1.0) / e);
        powers = 2;
        step = halley(a, w / x, e, x, a * x);
    }
    x -= step;
    while (powers < HYST_POWER_LIMIT && step > enough * x) {
        const hyst_real s = b * hyst_power(x, e - HYST_REAL(1.0));
        step = halley(a, s, e, x, (a + s) * x - w);
        x -= step;
        step = magnitude(step);
        ++powers;
    }
    return x;
}

static hyst_real inverse_power_law(const hyst_power_law *f, hyst_real w)
{
    const hyst_real zero = HYST_REAL(0.0);
    const hyst_real one = HYST_REAL(1.0);
    if (!(w > zero)) {
        return zero;
    }
    if (!(f->factor > zero)) {
        return w / f->linear;
    }
    if (!(f->linear > zero)) {
        return hyst_power(w / f->factor, one / f->exponent);
    }
    if (f->exponent > one) {
        return solve_power_law(f->linear, f->factor, f->exponent, w);
    }
    /* With t = x^exponent the line and the power change places. */
    return hyst_power(solve_power_law(f->factor, f->linear, one / f->exponent, w),
                      one / f->exponent);
}

/* Newton's method inside a bracket that always holds the solution; after twenty steps it only
 * halves, so that HYST_POLYNOMIAL_LIMIT evaluations exhaust any precision. */
static hyst_real inverse_polynomial(const hyst_polynomial *f, hyst_real w)
{
    hyst_real low = HYST_REAL(0.0), high = w / f->least_slope;
    hyst_real x = high;
    for (int i = 0; i < HYST_POLYNOMIAL_LIMIT; ++i) {
        const hyst_real residual = polynomial(f, x) - w;
        hyst_real next;
        if (residual > HYST_REAL(0.0)) {
            high = x;
        } else {
            low = x;
        }
        next = x - residual / polynomial_slope(f, x);
        if (i >= 20 || !(next > low && next < high)) {
            next = low + HYST_REAL(0.5) * (high - low);
        }
        if (!(next < x) && !(next > x)) {
            return x;
        }
        x = next;
    }
    return x;
}

hyst_real hyst_unloading(const hyst_loading_curve *curve, hyst_real w)
{
    switch (curve->kind) {
    case HYST_PLAYS: {
        const hyst_pieces *f = &curve->as.pieces;
        const size_t j = piece_at(f->value, f->count, w);
        return f->knot[j] + (w - f->value[j]) / f->slope[j];
    }
    case HYST_POLYNOMIAL:
        return inverse_polynomial(&curve->as.polynomial, w);
    case HYST_POWER_LAW:
    default:
        return inverse_power_law(&curve->as.power_law, w);
    }
}
