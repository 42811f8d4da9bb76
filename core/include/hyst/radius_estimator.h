/* Estimation of the radii of plays whose weights are known (S2 secs. III-B and III-C).
 *
 * The 18 cases of S2 are one linear regression. A play on its envelope gives z = u - s r with s the
 * sign of du, one in its interior z = u_m + s_m r with u_m the input at which it left its envelope;
 * the regime of every play follows from the measured slope dy/du, which is p0 + p_1 + .. + p_k when
 * the first k plays are on their envelopes (S2 lemma 1). So
 *   y = p0 u + sum_i p_i z_i is linear in r, phi_i = -s p_i on the envelope, s_m p_i inside,
 * and after a reversal from all envelopes this is
 *   phi' r = s (sum_envelope p u + sum_interior p u_m - y), phi_i = +p_i and -p_i.
 * Gradient: r += gain_i phi_i e, e = y - prediction. Least squares: r += P phi e / (phi' P phi + 1).
 * Either is followed by the projection onto 0 <= r_1 <= .. <= r_n (isotonic.h), that of the gradient
 * in the metric of its gains, in which its step approaches the truth.
 *
 * Slope filter: the regression of y on u since the last reversal, the weight of a sample falling by
 * the factor `memory` per sample; memory 0 gives the plain difference of two samples. A reversal
 * counts once u has gone back by more than dead_band. Nothing is estimated during the first
 * dead_time samples after one, nor while the slope is farther from every slope of the model than
 * `tolerance` of the way to half the distance between two. Noise makes that regime wrong; whoever
 * knows the slope or the regime better tells it (hyst_radius_step_told).
 *
 * Operations of one step: gradient 20 n + 40 of + - * and compare, 2 divisions, and the projection;
 * least squares 3.5 n^2 + 15 n more. */
#ifndef HYST_RADIUS_ESTIMATOR_H
#define HYST_RADIUS_ESTIMATOR_H

#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    size_t plays;
    hyst_real p0;
    const hyst_real *p;     /* weights > 0, or 0 for a play that is left alone */
    const hyst_real *gain;  /* of the gradient, times the sample time */
    int least_squares;      /* 0: gradient, 1: recursive least squares */
    hyst_real growth;       /* of the standard errors per sample, 1 / sqrt(forgetting factor) */
    const hyst_real *limit; /* variances at the start, never exceeded; for least squares only */
    hyst_real most_radius;
    hyst_real memory;    /* of the slope filter, 0 <= memory < 1 */
    hyst_real dead_time; /* samples */
    hyst_real dead_band; /* of reversals, in units of u */
    hyst_real tolerance; /* 0 < tolerance <= 1 */
} hyst_radius;

/* Places in the state. */
enum {
    HYST_RADIUS_ERROR,   /* prediction error of the last sample that was used */
    HYST_RADIUS_SLOPE,   /* filtered slope */
    HYST_RADIUS_REGIME,  /* plays on their envelopes, or -1 if the slope fits no regime */
    HYST_RADIUS_UPDATES, /* samples used */
    HYST_RADIUS_SKIPPED, /* samples not finite, too large to be squared, or leading to an overflow */
    HYST_RADIUS_SQUARES, /* means of the last 150 squared errors, and of their products with the */
    HYST_RADIUS_PRODUCTS, /* error before each */
    HYST_RADIUS_TOLD,    /* samples used whose regime came from outside */
    HYST_RADIUS_STARTED, /* 0: no sample yet, 1: yes, 2: but the last output is not known */
    HYST_RADIUS_INPUT,     /* last input */
    HYST_RADIUS_DIRECTION, /* s */
    HYST_RADIUS_EXTREME,   /* farthest input since the last reversal, and the output there */
    HYST_RADIUS_OUTPUT,
    HYST_RADIUS_MEAN_U, /* of the slope filter */
    HYST_RADIUS_MEAN_Y,
    HYST_RADIUS_UU,
    HYST_RADIUS_UY,
    HYST_RADIUS_SINCE,  /* samples since the last reversal */
    HYST_RADIUS_MOST,   /* plays seen on their envelopes since then */
    HYST_RADIUS_R
};

typedef struct {
    size_t r, free;            /* radii; what least squares goes on from, before the projection */
    size_t home, side, age;    /* input at which a play left its envelope, and which one (+1
                                  upper, -1 lower); samples since it last changed */
    size_t d, u;               /* factors of the covariance */
    size_t scratch, length;
} hyst_radius_layout;

hyst_radius_layout hyst_radius_places(const hyst_radius *radius);

/* Sets the whole state but the radii, which the caller has written. z0: memory before the first
 * sample, known. */
void hyst_radius_start(const hyst_radius *radius, hyst_real *state, const hyst_real *z0);

/* One sample; 1 if it was used, 0 if it was not. */
int hyst_radius_step(const hyst_radius *radius, hyst_real *state, hyst_real u, hyst_real y);

/* One sample whose regime does not come from the measured slope. Where is_slope it comes from the
 * slope `told` by somebody who measures it better, else `told` is the number of plays on their
 * envelopes itself, 0 to plays. NaN: unknown, then the sample is used only if the input rests. The
 * slope filter goes on, so that told and measured samples may follow each other. */
int hyst_radius_step_told(const hyst_radius *radius, hyst_real *state, hyst_real u, hyst_real y,
                          int is_slope, hyst_real told);

/* An input whose output was not measured: plays follow it with the radii they have. */
void hyst_radius_follow(const hyst_radius *radius, hyst_real *state, hyst_real u);

#ifdef HYST_EXTERN_C
}
#endif

#endif
