/* The power evaluations of the inverse are counted, so the curves are compiled in here with a power
 * function that counts; its values are the core's own. */
#include "check.h"

#define hyst_loading counted_loading
#define hyst_unloading counted_unloading
#define hyst_loading_slope counted_loading_slope
hyst_real counted_loading(const hyst_loading_curve *curve, hyst_real x);
hyst_real counted_unloading(const hyst_loading_curve *curve, hyst_real w);
hyst_real counted_loading_slope(const hyst_loading_curve *curve, hyst_real x);
static int power_count = 0;
static hyst_real counting_power(hyst_real x, hyst_real e)
{
    ++power_count;
    return hyst_power(x, e);
}
#define hyst_power counting_power
#include "../src/loading_curve.c"
#undef hyst_power
#undef hyst_loading
#undef hyst_unloading
#undef hyst_loading_slope

/* libm's pow as the reference, in double for both precisions: with e |log2 x| <= 400 the bound of
 * the header, (4 + 2 e |log2 x|) epsilon, and two roundings of libm's own. */
static void power_is_as_accurate_as_it_says(void)
{
    const hyst_real exponents[] = {R(0.25), R(1.0), R(1.5), R(2.0), R(3.3), R(8.0)};
    const double most = sizeof(hyst_real) == 8 ? 400.0 : 100.0;
    static hyst_real noise[4000];
    fill_with_noise(noise, COUNT(noise), R(30.0));
    for (size_t k = 0; k < COUNT(noise); ++k) {
        const hyst_real x = (hyst_real)exp2((double)noise[k]);
        for (size_t i = 0; i < COUNT(exponents); ++i) {
            const hyst_real e = exponents[i];
            const double size = fabs((double)e * log2((double)x));
            const double expected = pow((double)x, (double)e);
            if (size > most) {
                continue;
            }
            CHECK_NEAR((double)hyst_power(x, e) / expected, 1.0,
                       (4.0 + 2.0 * size) * (double)REAL_EPSILON + 2.0 * DBL_EPSILON);
        }
    }
}

static void power_at_the_ends_of_its_range(void)
{
    CHECK_EQUAL(hyst_power(R(0.0), R(1.5)), R(0.0));
    CHECK_EQUAL(hyst_power(R(1.0), R(7.0)), R(1.0));
    CHECK_EQUAL(hyst_power(R(2.0), R(-3.0)), R(0.125));
    CHECK_EQUAL(hyst_power(R(1e-30), R(40.0)), R(0.0));
    CHECK(!hyst_is_finite(hyst_power(R(1e30), R(40.0))));
    /* Smaller than any normal number, and still a number: 2^-1030 or 2^-130. */
    CHECK_EQUAL(hyst_power(R(0.5), sizeof(hyst_real) == 8 ? R(1030.0) : R(130.0)),
                (hyst_real)exp2(sizeof(hyst_real) == 8 ? -1030.0 : -130.0));
    CHECK_EQUAL(hyst_power((hyst_real)exp2(sizeof(hyst_real) == 8 ? -1030.0 : -130.0), R(0.5)),
                (hyst_real)exp2(sizeof(hyst_real) == 8 ? -515.0 : -65.0));
}

static hyst_loading_curve power_law(double linear, double factor, double exponent)
{
    hyst_loading_curve f;
    f.kind = HYST_POWER_LAW;
    f.as.power_law.linear = (hyst_real)linear;
    f.as.power_law.factor = (hyst_real)factor;
    f.as.power_law.exponent = (hyst_real)exponent;
    return f;
}

/* x + x^2 = w has x = (sqrt(1 + 4 w) - 1) / 2 = 2 w / (1 + sqrt(1 + 4 w)). */
static void quadratic_is_solved_as_by_its_formula(void)
{
    const hyst_loading_curve f = power_law(1.0, 1.0, 2.0);
    for (double w = 1e-9; w < 1e9; w *= 1.7) {
        const double x = 2.0 * w / (1.0 + sqrt(1.0 + 4.0 * w));
        /* The result is off by the rounding of f itself and by libm's few roundings. */
        CHECK_NEAR((double)hyst_unloading(&f, (hyst_real)w) / x, 1.0, 8.0 * (double)REAL_EPSILON);
        CHECK_NEAR((double)hyst_loading(&f, (hyst_real)x) / w, 1.0,
                   (16.0 + 4.0 * fabs(log2(x))) * (double)REAL_EPSILON);
    }
}

/* Every shape of a x + b x^e = 1 there is: scaled so that its larger part reaches 1 at x = 1. */
static void inverse_takes_no_more_powers_than_stated(void)
{
    static const double exponents[] = {1.0001, 1.01, 1.1, 1.5,  2.0,  2.5,   3.0,
                                       4.0,    5.0,  7.0, 10.0, 21.0, 100.0, 1000.0};
    int most = 0, most_usual = 0;
    for (size_t i = 0; i < COUNT(exponents); ++i) {
        for (double ratio = -12.0; ratio <= 12.0; ratio += 0.02) {
            const double a = ratio > 0.0 ? pow(10.0, -ratio) : 1.0;
            const double b = ratio < 0.0 ? pow(10.0, ratio) : 1.0;
            const hyst_loading_curve f = power_law(a, b, exponents[i]);
            double x, residual;
            power_count = 0;
            x = (double)counted_unloading(&f, R(1.0));
            most = power_count > most ? power_count : most;
            if (exponents[i] <= 21.0) {
                most_usual = power_count > most_usual ? power_count : most_usual;
            }
            residual = (double)f.as.power_law.linear * x +
                       (double)f.as.power_law.factor * pow(x, (double)f.as.power_law.exponent);
            /* An error of x counts at most e times in the residual; that of f'(x) x >= f bounds it
             * below by one. A few roundings, and those the power brings in. */
            CHECK_NEAR(residual, 1.0, (12.0 + 4.0 * exponents[i]) * (double)REAL_EPSILON);
        }
    }
    CHECK(most <= HYST_POWER_LIMIT);
    CHECK(most == 6); /* the limit is needed, at an exponent of 1000 */
    CHECK(most_usual == 5);
    power_count = 0;
    {
        const hyst_loading_curve f = power_law(1.0, 1.0, 2.5);
        (void)counted_loading(&f, R(0.7));
    }
    CHECK(power_count == 1);
}

static void softening_and_pure_power_laws_have_inverses(void)
{
    const double laws[][3] = {{1.0, 1.0, 0.5}, {1e-6, 1.0, 0.3}, {1.0, 1e-6, 0.9},
                              {0.0, 2.0, 1.7}, {0.0, 2.0, 0.6},  {3.0, 0.0, 2.0}};
    for (size_t i = 0; i < COUNT(laws); ++i) {
        const hyst_loading_curve f = power_law(laws[i][0], laws[i][1], laws[i][2]);
        for (double x = 1e-4; x < 1e4; x *= 2.3) {
            const hyst_real w = hyst_loading(&f, (hyst_real)x);
            /* x counts at least e times in w: an error of w is divided by e >= 0.3; the powers there
             * and back add (4 + 2 |log2|) epsilon each, with |log2| below 25. */
            power_count = 0;
            CHECK_NEAR((double)counted_unloading(&f, w) / x, 1.0, 400.0 * (double)REAL_EPSILON);
            CHECK(power_count <= HYST_POWER_LIMIT + 1);
        }
    }
    {
        const hyst_loading_curve f = power_law(1.0, 1.0, 2.0);
        CHECK_EQUAL(hyst_unloading(&f, R(0.0)), R(0.0));
    }
}

/* Slopes 1, 3, 2 from 0, 1, 2 on: f = 0, 1, 4 there. */
static void pieces_by_hand(void)
{
    const hyst_real knot[] = {R(0.0), R(1.0), R(2.0)};
    const hyst_real value[] = {R(0.0), R(1.0), R(4.0)};
    const hyst_real slope[] = {R(1.0), R(3.0), R(2.0)};
    const hyst_real x[] = {R(0.0), R(0.5), R(1.0), R(1.5), R(2.0), R(10.0)};
    const hyst_real y[] = {R(0.0), R(0.5), R(1.0), R(2.5), R(4.0), R(20.0)};
    hyst_loading_curve f;
    f.kind = HYST_PLAYS;
    f.as.pieces.count = 3;
    f.as.pieces.knot = knot;
    f.as.pieces.value = value;
    f.as.pieces.slope = slope;
    for (size_t k = 0; k < COUNT(x); ++k) {
        CHECK_EQUAL(hyst_loading(&f, x[k]), y[k]);
        CHECK_EQUAL(hyst_unloading(&f, y[k]), x[k]);
    }
    CHECK_EQUAL(hyst_loading_slope(&f, R(1.5)), R(3.0));
}

/* f = x - x^2 + x^3: slope 1 - 2 x + 3 x^2, least at 1/3, where it is 2/3; neither convex nor
 * concave. f(1) = 1, f(2) = 6, f(3) = 21, f(10) = 910. */
static void polynomial_by_hand(void)
{
    const hyst_real coefficient[] = {R(1.0), R(-1.0), R(1.0)};
    const hyst_real x[] = {R(0.0), R(1.0), R(2.0), R(3.0), R(10.0)};
    const hyst_real y[] = {R(0.0), R(1.0), R(6.0), R(21.0), R(910.0)};
    hyst_loading_curve f;
    f.kind = HYST_POLYNOMIAL;
    f.as.polynomial.count = 3;
    f.as.polynomial.coefficient = coefficient;
    f.as.polynomial.least_slope = R(0.66);
    for (size_t k = 0; k < COUNT(x); ++k) {
        CHECK_EQUAL(hyst_loading(&f, x[k]), y[k]);
        /* f is off by a few roundings of its largest term, at most 1.1 f, and f' x >= f / 2. */
        CHECK_NEAR((double)hyst_unloading(&f, y[k]), (double)x[k],
                   16.0 * (double)REAL_EPSILON * (double)x[k]);
    }
    CHECK_EQUAL(hyst_loading_slope(&f, R(2.0)), R(9.0));
    for (double w = 1e-6; w < 1e6; w *= 1.3) {
        const hyst_real there = hyst_unloading(&f, (hyst_real)w);
        CHECK_NEAR((double)hyst_loading(&f, there) / w, 1.0, 64.0 * (double)REAL_EPSILON);
    }
}

static hyst_loading_curve exponential_of(double c, double d, double b)
{
    hyst_loading_curve f;
    f.kind = HYST_EXPONENTIAL;
    f.as.exponential.first = (hyst_real)(c - d);
    f.as.exponential.last = (hyst_real)c;
    f.as.exponential.change = (hyst_real)d;
    f.as.exponential.way = (hyst_real)b;
    return f;
}

/* f(x) = c x - d b (1 - exp(-x / b)): 1/e at 1 for c = d = b = 1, and 1 - 1/e for c = 0, d = -1. */
static void exponentials_by_hand(void)
{
    const hyst_loading_curve stiffens = exponential_of(1.0, 1.0, 1.0);
    const hyst_loading_curve saturates = exponential_of(0.0, -1.0, 1.0);
    const hyst_loading_curve line = exponential_of(2.0, 0.0, 1.0);
    CHECK_NEAR((double)hyst_loading(&stiffens, R(1.0)), 0.36787944117144233, 8.0 * (double)REAL_EPSILON);
    CHECK_NEAR((double)hyst_loading(&saturates, R(1.0)), 0.6321205588285577, 8.0 * (double)REAL_EPSILON);
    CHECK_NEAR((double)hyst_loading_slope(&stiffens, R(1.0)), 0.6321205588285577,
               8.0 * (double)REAL_EPSILON);
    CHECK_NEAR((double)hyst_unloading(&stiffens, R(0.36787944117144233)), 1.0,
               16.0 * (double)REAL_EPSILON);
    CHECK_NEAR((double)hyst_unloading(&saturates, R(0.6321205588285577)), 1.0,
               16.0 * (double)REAL_EPSILON);
    CHECK_EQUAL(hyst_unloading(&line, R(3.0)), R(1.5));
    CHECK_EQUAL(hyst_unloading(&stiffens, R(0.0)), R(0.0));
    /* Nothing leads beyond saturation. */
    CHECK(!hyst_is_finite(hyst_unloading(&saturates, R(1.0))));
    CHECK(!hyst_is_finite(hyst_unloading(&saturates, R(2.0))));
}

/* Slopes and ways over decades, there and back: the stated number of steps is enough for all. */
static void every_exponential_is_solved(void)
{
    for (double last = -6.0; last <= 3.0; last += 0.5) {
        for (double first = -6.0; first <= 3.0; first += 0.5) {
            const double c = pow(10.0, last), d = c - pow(10.0, first);
            const hyst_loading_curve f = exponential_of(c, d, 1.0);
            for (double size = -4.0; size <= 3.0; size += 0.23) {
                const hyst_real w = hyst_loading(&f, (hyst_real)pow(10.0, size));
                const hyst_real again = hyst_loading(&f, hyst_unloading(&f, w));
                /* x f' is at most twice f: a few roundings of f, each twice. */
                CHECK_NEAR((double)again / (double)w, 1.0, 20.0 * (double)REAL_EPSILON);
            }
        }
    }
}

/* 2 x - x^2 up to 1, then 1 + x / 2 more: uniform sliders beside a spring of 1/2. */
static void iwan_by_hand(void)
{
    hyst_loading_curve f;
    f.kind = HYST_IWAN;
    f.as.iwan.stiffness = R(2.5);
    f.as.iwan.factor = R(1.0);
    f.as.iwan.exponent = R(2.0);
    f.as.iwan.limit = R(1.0);
    f.as.iwan.force = R(1.0);
    f.as.iwan.residual = R(0.5);
    CHECK_NEAR((double)hyst_loading(&f, R(0.5)), 1.0, 8.0 * (double)REAL_EPSILON);
    CHECK_EQUAL(hyst_loading(&f, R(1.0)), R(1.5));
    CHECK_EQUAL(hyst_loading(&f, R(3.0)), R(2.5));
    CHECK_NEAR((double)hyst_loading_slope(&f, R(0.5)), 1.5, 16.0 * (double)REAL_EPSILON);
    CHECK_EQUAL(hyst_loading_slope(&f, R(3.0)), R(0.5));
    CHECK_NEAR((double)hyst_unloading(&f, R(1.0)), 0.5, 16.0 * (double)REAL_EPSILON);
    CHECK_EQUAL(hyst_unloading(&f, R(1.5)), R(1.0));
    CHECK_EQUAL(hyst_unloading(&f, R(2.5)), R(3.0));
    CHECK_EQUAL(hyst_unloading(&f, R(0.0)), R(0.0));
    for (double x = 1e-4; x < 4.0; x *= 1.1) {
        const hyst_real w = hyst_loading(&f, (hyst_real)x);
        CHECK_NEAR((double)hyst_loading(&f, hyst_unloading(&f, w)) / (double)w, 1.0,
                   20.0 * (double)REAL_EPSILON);
    }
    /* Without the spring macro-slip has no way. */
    f.as.iwan.stiffness = R(2.0);
    f.as.iwan.residual = R(0.0);
    CHECK(!hyst_is_finite(hyst_unloading(&f, R(1.0))));
    CHECK_NEAR((double)hyst_unloading(&f, R(0.75)), 0.5, 16.0 * (double)REAL_EPSILON);
}

int main(void)
{
    exponentials_by_hand();
    every_exponential_is_solved();
    iwan_by_hand();
    power_is_as_accurate_as_it_says();
    power_at_the_ends_of_its_range();
    quadratic_is_solved_as_by_its_formula();
    inverse_takes_no_more_powers_than_stated();
    softening_and_pure_power_laws_have_inverses();
    pieces_by_hand();
    polynomial_by_hand();
    return check_result();
}
