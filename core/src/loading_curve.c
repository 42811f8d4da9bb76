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

/* Beyond the largest number in any precision, as a power of two. */
#define CURVE_BEYOND HYST_REAL(1e6)
#define CURVE_LN2 HYST_REAL(0.6931471805599453)
#define CURVE_LOG2_E HYST_REAL(1.4426950408889634)

/* 1 - exp(-t) for t >= 0, with all its digits where t is small. */
static hyst_real lost(hyst_real t)
{
    if (t < HYST_REAL(0.25)) {
        hyst_real sum = HYST_REAL(1.0);
        for (size_t k = 13; k > 1u; --k) {
            sum = HYST_REAL(1.0) - sum * t / (hyst_real)k;
        }
        return t * sum;
    }
    return HYST_REAL(1.0) - hyst_exp2(-CURVE_LOG2_E * t);
}

/* x - way (1 - exp(-t)) with t = x / way, likewise: way (t^2 / 2 - t^3 / 6 + ..). */
static hyst_real gained(hyst_real x, hyst_real way, hyst_real t)
{
    if (t < HYST_REAL(0.5)) {
        hyst_real sum = HYST_REAL(1.0);
        for (size_t k = 15; k > 2u; --k) {
            sum = HYST_REAL(1.0) - sum * t / (hyst_real)k;
        }
        return HYST_REAL(0.5) * t * x * sum;
    }
    return x - way * lost(t);
}

/* f(x) of another way b, in the form in which no term takes away from another. However small the way
 * is, the result is finite. */
static hyst_real exponential_loading(const hyst_exponential *f, hyst_real x, hyst_real way)
{
    const hyst_real t = x / way;
    return f->change < HYST_REAL(0.0) ? f->last * x - f->change * (way * lost(t))
                                      : f->first * x + f->change * gained(x, way, t);
}

static hyst_real exponential_slope(const hyst_exponential *f, hyst_real t)
{
    return f->change < HYST_REAL(0.0) ? f->last - f->change * hyst_exp2(-CURVE_LOG2_E * t)
                                      : f->first + f->change * lost(t);
}

static hyst_real iwan(const hyst_iwan *f, hyst_real x)
{
    if (x < f->limit) {
        return x * (f->stiffness - f->factor * hyst_power(x, f->exponent - HYST_REAL(1.0)));
    }
    return f->force + f->residual * x;
}

static hyst_real iwan_slope(const hyst_iwan *f, hyst_real x)
{
    if (x < f->limit) {
        return f->stiffness -
               f->exponent * f->factor * hyst_power(x, f->exponent - HYST_REAL(1.0));
    }
    return f->residual;
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
    case HYST_EXPONENTIAL:
        return exponential_loading(&curve->as.exponential, x, curve->as.exponential.way);
    case HYST_IWAN:
        return iwan(&curve->as.iwan, x);
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
    case HYST_EXPONENTIAL:
        return exponential_slope(&curve->as.exponential, x / curve->as.exponential.way);
    case HYST_IWAN:
        return iwan_slope(&curve->as.iwan, x);
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

/* The t > 0 with f(b t) / b = w > 0 of a slope that grows from a to c = a + d.
 *
 * The left side is convex, so Newton's steps go down from any t that is too large: w / a; (w + d) / c,
 * since no more than d is lost; and the root of 3 w / d where that is below 1, since t - 1 + exp(-t)
 * is at least t^2 / 3 there. The least of them is near. */
static hyst_real solve_growing(const hyst_exponential *f, hyst_real w)
{
    const hyst_real square = HYST_REAL(3.0) * w;
    hyst_real t = (w + f->change) / f->last;
    if (square < f->change) {
        const hyst_real root = hyst_power(square / f->change, HYST_REAL(0.5));
        t = root < t ? root : t;
    }
    if (w < f->first * t) {
        t = w / f->first;
    }
    for (int i = 0; i < HYST_EXPONENTIAL_LIMIT; ++i) {
        const hyst_real step = (exponential_loading(f, t, HYST_REAL(1.0)) - w) / exponential_slope(f, t);
        if (!(step > HYST_REAL(0.0))) {
            return t;
        }
        t -= step;
        if (step * step < HYST_REAL(1e-17) * t * t) {
            return t;
        }
    }
    return t;
}

/* -ln(1 - v) for 0 <= v < 1. */
static hyst_real unlost(hyst_real v)
{
    if (v < HYST_REAL(0.25)) {
        /* 2 artanh(q) with q = v / (2 - v). */
        const hyst_real q = v / (HYST_REAL(2.0) - v);
        const hyst_real s = q * q;
        hyst_real sum = HYST_REAL(0.0);
        for (size_t k = 10; k > 0u; --k) {
            sum = (sum + HYST_REAL(1.0) / (hyst_real)(2u * k + 1u)) * s;
        }
        return HYST_REAL(2.0) * q * (HYST_REAL(1.0) + sum);
    }
    return -CURVE_LN2 * hyst_log2(HYST_REAL(1.0) - v);
}

/* The same of a slope that falls from c + e to c > 0:  c t + e (1 - exp(-t)) = w.
 *
 * Concave, so Newton's steps go up from any t that is too small: w / (c + e), or (w - e) / c. They are
 * no longer than 1 where the exponential decides; those of  t + ln(1 - (w - c t) / e) = 0, which is
 * concave too, are fast just there. The longer one is never too long. */
static hyst_real solve_falling(const hyst_exponential *f, hyst_real w)
{
    const hyst_real e = -f->change;
    hyst_real t = w / f->first;
    if (w - e > f->last * t) {
        t = (w - e) / f->last;
    }
    for (int i = 0; i < HYST_EXPONENTIAL_LIMIT; ++i) {
        hyst_real step = (w - exponential_loading(f, t, HYST_REAL(1.0))) / exponential_slope(f, t);
        const hyst_real rest = (e - w + f->last * t) / e;
        if (t > HYST_REAL(1.0) && rest > HYST_REAL(0.0)) {
            const hyst_real other = -(t + CURVE_LN2 * hyst_log2(rest)) * rest / (rest + f->last / e);
            step = other > step ? other : step;
        }
        t += step;
        if (step * step < HYST_REAL(1e-17) * t * t) {
            return t;
        }
    }
    return t;
}

static hyst_real inverse_exponential(const hyst_exponential *f, hyst_real value)
{
    const hyst_real zero = HYST_REAL(0.0);
    const hyst_real w = value / f->way;
    if (!(w > zero)) {
        return zero;
    }
    if (!(f->change < zero)) {
        return f->change > zero ? f->way * solve_growing(f, w) : value / f->last;
    }
    if (f->last > zero) {
        return f->way * solve_falling(f, w);
    }
    if (!(w < f->first)) {
        return hyst_exp2(CURVE_BEYOND); /* an infinity: no way leads there */
    }
    return f->way * unlost(w / f->first);
}

/* Concave, so Newton's steps go up from w / stiffness, which is too small. */
static hyst_real inverse_iwan(const hyst_iwan *f, hyst_real w)
{
    hyst_real x = w / f->stiffness;
    if (!(w > HYST_REAL(0.0))) {
        return HYST_REAL(0.0);
    }
    if (!(w < f->force + f->residual * f->limit)) {
        return f->residual > HYST_REAL(0.0) ? (w - f->force) / f->residual
                                            : hyst_exp2(CURVE_BEYOND);
    }
    for (int i = 0; i < HYST_IWAN_LIMIT; ++i) {
        const hyst_real lost_stiffness =
            f->factor * hyst_power(x, f->exponent - HYST_REAL(1.0));
        const hyst_real slope = f->stiffness - f->exponent * lost_stiffness;
        const hyst_real step = (w - x * (f->stiffness - lost_stiffness)) / slope;
        if (!(step > HYST_REAL(0.0))) {
            return x;
        }
        x += step;
        if (!(x < f->limit)) {
            return f->limit;
        }
        if (step * step < HYST_REAL(1e-18) * x * x) {
            return x;
        }
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
    case HYST_EXPONENTIAL:
        return inverse_exponential(&curve->as.exponential, w);
    case HYST_IWAN:
        return inverse_iwan(&curve->as.iwan, w);
    case HYST_POWER_LAW:
    default:
        return inverse_power_law(&curve->as.power_law, w);
    }
}
