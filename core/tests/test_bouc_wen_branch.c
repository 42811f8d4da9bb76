/* Branches of Bouc-Wen's model against closed forms. */
#include "hyst/bouc_wen_branch.h"

#include "check.h"

#define CLOSE (30.0 * (double)REAL_EPSILON)

/* n = 2: artanh and arctan; n = 1: logarithms; n = 1/2, with t = r^2: -2 r - 2 ln(1 - r) and
 * 2 r - 2 ln(1 + r), the latter of ratio 1. */
static double rising(double n, double share)
{
    const double root = sqrt(share);
    return n > 1.5 ? atanh(share) : n > 0.75 ? -log1p(-share) : -2.0 * root - 2.0 * log1p(-root);
}

static double falling(double n, double ratio, double share)
{
    const double root = sqrt(ratio), half = sqrt(share);
    if (n > 1.5) {
        return atan(root * share) / root;
    }
    if (n > 0.75) {
        return log1p(ratio * share) / ratio;
    }
    return 2.0 * half / ratio - 2.0 * log1p(ratio * half) / (ratio * ratio);
}

/* Both sides of where the forms of the way meet, and of where the fraction goes deeper. */
static const hyst_real shares[] = {R(1e-6), R(0.01), R(0.3), R(0.5), R(0.7), R(0.76),
                                   R(0.85), R(0.87), R(0.95), R(0.999)};
static const hyst_real exponents[] = {R(0.5), R(1.0), R(2.0)};

static void ways_of_closed_forms(void)
{
    const hyst_real ratios[] = {R(0.25), R(1.0), R(3.0), R(100.0), R(900.0)};
    for (size_t i = 0; i < COUNT(exponents); ++i) {
        const hyst_real n = exponents[i], join = hyst_bouc_wen_join(n);
        for (size_t j = 0; j < COUNT(shares); ++j) {
            /* A share that is given to an epsilon: the way is known to that over 1 - share^n. */
            const double share = (double)shares[j], way = rising((double)n, share);
            const double known = CLOSE * (share + way) + (double)REAL_EPSILON / (1.0 - share);
            CHECK_NEAR((double)hyst_bouc_wen_rising(n, join, shares[j]), way, known);
            for (size_t k = 0; k < COUNT(ratios); ++k) {
                const double down = falling((double)n, (double)ratios[k], share);
                /* The closed form of n = 1/2 is the difference of two roots, in double. */
                CHECK_NEAR((double)hyst_bouc_wen_falling(n, ratios[k], shares[j]), down,
                           CLOSE * down + 4.0 * DBL_EPSILON * sqrt(share));
            }
        }
    }
}

/* A share, its way, and back; tilted too. */
static void shares_are_found_again(void)
{
    const hyst_real more[] = {R(0.1), R(0.5), R(0.9), R(1.0), R(1.7), R(2.0), R(10.0), R(100.0)};
    const hyst_real tilts[] = {R(0.0), R(-0.7), R(3.0), R(200.0)};
    for (size_t i = 0; i < COUNT(more); ++i) {
        const hyst_real n = more[i], join = hyst_bouc_wen_join(n);
        for (size_t j = 0; j < COUNT(shares); ++j) {
            for (size_t k = 0; k < COUNT(tilts); ++k) {
                const hyst_real way = hyst_bouc_wen_rising(n, join, shares[j]) + tilts[k] * shares[j];
                /* The way is rounded once, and read with the slope 1 + tilt at least. */
                CHECK_NEAR((double)hyst_bouc_wen_risen(n, join, tilts[k], R(0.0), way),
                           (double)shares[j], CLOSE * (double)shares[j]);
            }
            const hyst_real ratio = R(2.0), start = R(1.0);
            const hyst_real down = hyst_bouc_wen_falling(n, ratio, start) -
                                   hyst_bouc_wen_falling(n, ratio, shares[j]);
            /* The difference of two ways of at most 1 is read where its slope is 1/3 or more. */
            CHECK_NEAR((double)hyst_bouc_wen_fallen(n, ratio, R(0.0), start, down),
                       (double)shares[j], 3.0 * CLOSE);
        }
    }
}

/* No way is no change, at the limit nothing moves, and no way leads beyond it. */
static void ends(void)
{
    const hyst_real join = hyst_bouc_wen_join(R(1.5));
    CHECK_EQUAL(hyst_bouc_wen_risen(R(1.5), join, R(0.0), R(1.0), R(3.0)), R(1.0));
    CHECK_EQUAL(hyst_bouc_wen_risen(R(1.5), join, R(0.0), R(0.0), R(1e30)), R(1.0));
    CHECK_EQUAL(hyst_bouc_wen_risen(R(1.5), join, R(0.0), R(0.0), R(0.0)), R(0.0));
    CHECK_EQUAL(hyst_bouc_wen_rising(R(1.5), join, R(0.0)), R(0.0));
    CHECK_EQUAL(hyst_bouc_wen_falling(R(1.5), R(0.5), R(0.0)), R(0.0));
    /* n = 1 needs no join: -ln(1 - share) is its way throughout; rounding of two sums near 1. */
    CHECK_NEAR((double)hyst_bouc_wen_join(R(1.0)), 0.0, CLOSE);
}

/* Ways over which what is left of 1 gets lost in the digits of the share: n = 1, where it is exp(-way),
 * and n = 2, where the share is tanh(way). */
static void next_to_the_limit(void)
{
    const hyst_real join = hyst_bouc_wen_join(R(2.0));
    for (int i = 0; i < 800; ++i) {
        const hyst_real way = R(0.0625) * (hyst_real)i;
        CHECK_NEAR((double)hyst_bouc_wen_risen(R(1.0), R(0.0), R(0.0), R(0.0), way),
                   -expm1(-(double)way), CLOSE);
        CHECK_NEAR((double)hyst_bouc_wen_risen(R(2.0), join, R(0.0), R(0.0), way),
                   tanh((double)way), CLOSE);
    }
}

int main(void)
{
    ways_of_closed_forms();
    shares_are_found_again();
    ends();
    next_to_the_limit();
    return check_result();
}
