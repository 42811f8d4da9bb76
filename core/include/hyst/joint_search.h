/* A joint estimator that looks for a better minimum.
 *
 * The output is piecewise linear in the radii, so a recursive estimate of them can settle in a false
 * minimum. The same plant is linear in the weights of many plays of fixed radii ("cells"), where
 * there are no false minima. So beside the estimate runs
 *   gathering: recursive least squares on the weights of the cells, until the input has turned twice;
 *   merging:   the cells become as many plays as the estimate has: the two neighbours whose union
 *              changes the loading curve least, in the mean square, become one with their weight and
 *              their mean radius, one union a sample;
 *   on trial:  a rival estimate started from those plays. It replaces the estimate once the squares
 *              of its errors are smaller beyond doubt:
 *                sum(e^2 - e_rival^2) > 3 sqrt(sum (e^2 - e_rival^2)^2)   (Vuong 1989),
 *              and is given up if they are larger, or if nothing is decided in many strokes. That
 *              test takes errors for independent. Those of a rival that follow each other (with a
 *              correlation of 0.5 or more) are no noise but those of a wrong model; then it replaces
 *              the estimate only if it also leaves less than a quarter of the estimate's squares.
 * Then it begins again. The input turns when it goes back by an eighth of its recent range.
 *
 * Besides, the correlation of successive errors is watched. Noise has none; errors of a model that
 * is wrong, or of an estimate in a false minimum, do.
 *
 * The step costs one of hyst_joint_step and at most one of: another one, or 2 c^2 + 12 c operations
 * for c = cells + 2 (as much again at a turn where the past is forgotten). The state holds
 * hyst_search_places().length numbers: with 32 cells 1388 at n = 5 and 2238 at n = 10. */
#ifndef HYST_JOINT_SEARCH_H
#define HYST_JOINT_SEARCH_H

#include "hyst/joint_estimator.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    const hyst_joint *joint;
    size_t cells;            /* at least as many as plays; 0: no search, errors are watched only */
    const hyst_real *radius; /* of the cells, > 0, ascending */
    const hyst_real *start;  /* p0, weights of the cells, offset */
    const hyst_real *limit;  /* and their variances at the start, which are never exceeded */
    hyst_real noise;         /* variance of y to start from; a small one is soon corrected */
} hyst_search;

/* Scalars of the search, from hyst_search_places().scalars on. */
enum {
    HYST_SEARCH_STAGE, /* 0 gathering, 1 merging, 2 on trial */
    HYST_SEARCH_TURNS, /* of the input, in this stage */
    HYST_SEARCH_COUNT, /* cells that are left to merge */
    HYST_SEARCH_GAIN,  /* sum of e^2 - e_rival^2, and of its square */
    HYST_SEARCH_GAIN_SQUARED,
    HYST_SEARCH_TRIALS,       /* rivals that were tried */
    HYST_SEARCH_REPLACEMENTS, /* and those that became the estimate */
    HYST_SEARCH_NOISE,        /* variance of the errors of the cells */
    HYST_SEARCH_SAMPLES,      /* of the cells */
    HYST_SEARCH_GROWTH,       /* what is to be forgotten at the next turn */
    HYST_SEARCH_SIDE,         /* envelope left last: +1 upper, the input falls; -1 lower */
    HYST_SEARCH_HOME,         /* input at the last turn, and the farthest one since */
    HYST_SEARCH_FAR,
    HYST_SEARCH_WAY,         /* of v between the last two turns */
    HYST_SEARCH_ERROR,       /* of the estimate, last sample */
    HYST_SEARCH_SQUARE,      /* mean of its square, and of the product with the one before */
    HYST_SEARCH_PRODUCT,
    HYST_SEARCH_SEEN,        /* samples in these means */
    HYST_SEARCH_RIVAL_SQUARE, /* sum of e_rival^2, and of the product with the one before */
    HYST_SEARCH_RIVAL_PRODUCT,
    HYST_SEARCH_RIVAL_ERROR, /* of the last sample */
    HYST_SEARCH_SCALARS
};

typedef struct {
    hyst_joint_layout joint; /* of the estimate, which comes first in the state */
    size_t scalars, rival;   /* the rival has the layout of the estimate, from `rival` on */
    size_t weight, d, u, z;  /* of the cells: p0, weights, offset; their covariance; memory */
    size_t point_weight, point_radius, point_cost; /* of what is merged */
    size_t scratch, length;
} hyst_search_layout;

hyst_search_layout hyst_search_places(const hyst_search *search);

/* Starts the search. The estimate has been started with hyst_joint_start before. */
void hyst_search_start(const hyst_search *search, hyst_real *state);

/* One sample: what hyst_joint_step does, and the search. */
hyst_joint_end hyst_search_step(const hyst_search *search, hyst_real *state, hyst_real u,
                                hyst_real y);

/* An input whose output was not measured: the memories follow. */
void hyst_search_follow(const hyst_search *search, hyst_real *state, hyst_real u);

/* Correlation of successive errors of the estimate, from -1 to 1. */
hyst_real hyst_search_correlation(const hyst_search *search, const hyst_real *state);

#ifdef HYST_EXTERN_C
}
#endif

#endif
