/* Joint estimation of a Prandtl-Ishlinskii model while it runs: weights, radii, offset and, where
 * there are any, the weights of a dead-zone map before the plays (generalized model) or after them
 * (modified model).
 *
 *   v = front(u),   z_i = play of radius r_i of v,   w = p0 v + sum_i p_i z_i,   y = back(w) + offset
 *
 * Recursive prediction error method, which is here the extended Kalman filter of constant
 * parameters: every play of the estimate is on an envelope or in its interior, and
 *   dz_i/dr_i = -1 on the lower envelope, +1 on the upper, and inside what it was on leaving one.
 * So the regime comes from the estimate's own memory and no slope is ever measured. An update moves
 * the memory along with its radius: afterwards z is what the input would have left in the new model.
 *
 * After every sample the estimate can be inverted: 0 <= r_1 <= .. <= r_n (isotonic.h), every
 * cumulative weight p0 + p_1 + .. + p_j within its bounds, both maps rising, the memory admissible.
 *
 * Forgetting multiplies a variance only while the input moves, for a play only while it is
 * excited (it has gone from one envelope to the other within `patience` samples), and only up to
 * the variance the estimate started with. So without excitation nothing winds up.
 *
 * Operations of one step for n plays and m = 2 n + 2 parameters (no maps), + - * / and comparisons:
 * about 6.5 m^2 + 20 m + 100 n, and 2 m^2 for each of at most HYST_JOINT_PROJECTIONS projections. At
 * n = 5 that is 1700, at most 2850; at n = 10 it is 4600, at most 8500. 3 m + n + 2 of them divide.
 * The state holds hyst_joint_places().length numbers, the scratch area included: 254 at n = 5 and
 * 679 at n = 10, which is 2032 and 5432 bytes in double. hyst_search_step (joint_search.h) adds 21
 * scalars, also without a search: 2200 and 5600 bytes. */
#ifndef HYST_JOINT_ESTIMATOR_H
#define HYST_JOINT_ESTIMATOR_H

#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

/* Projections in the metric of the covariance that one step makes at most; m^2 operations each. What
 * is left to do after them is done parameter by parameter. */
#define HYST_JOINT_PROJECTIONS 4

/* An error whose square is more than this many times its variance is an outlier: the larger it is,
 * the less it moves the estimate. */
#define HYST_JOINT_OUTLIER HYST_REAL(100.0)

/* The terms of a map: threshold 0 first, then the positive ones ascending, then the negative ones
 * descending. No terms: no map. */
typedef struct {
    size_t count;
    size_t positive; /* how many of them are > 0 */
    const hyst_real *threshold;
    hyst_real least_slope; /* > 0 */
    hyst_real most_slope;
} hyst_joint_map;

typedef struct {
    size_t plays;
    hyst_joint_map front;
    hyst_joint_map back;
    hyst_real least_slope; /* bounds of every cumulative weight, 0 < least < most */
    hyst_real most_slope;
    hyst_real most_radius;
    hyst_real forgetting;    /* 1 - lambda per sample, 0 <= .. < 1 */
    hyst_real noise_memory;  /* samples over which the noise is estimated, >= 1 */
    hyst_real least_noise;   /* > 0, variance of y */
    hyst_real least_share;   /* a variance factor never falls below this share of its limit */
    hyst_real patience;      /* samples after which an unexcited play is frozen */
    const hyst_real *limit;  /* variances at the start, which are never exceeded; 0 holds one fixed */
} hyst_joint;

/* Parameters: p0, p_1 .. p_n, r_1 .. r_n, offset, weights of the front map, of the back map. */
size_t hyst_joint_parameters(const hyst_joint *joint);

/* Places in the state. The scalars come first, then theta. */
enum {
    HYST_JOINT_ERROR,     /* prediction error of the last sample */
    HYST_JOINT_VARIANCE,  /* and its variance as predicted */
    HYST_JOINT_NOISE,     /* estimated variance of the noise of y */
    HYST_JOINT_STARTED,   /* 1 once there is a last input */
    HYST_JOINT_INPUT,     /* last input */
    HYST_JOINT_UPDATES,   /* samples used */
    HYST_JOINT_SKIPPED,   /* samples that were not finite */
    HYST_JOINT_REFUSED,   /* samples whose update would not have been finite */
    HYST_JOINT_LOW,       /* range of v over the present block of `patience` samples */
    HYST_JOINT_HIGH,
    HYST_JOINT_LOW_BEFORE, /* and over the block before */
    HYST_JOINT_HIGH_BEFORE,
    HYST_JOINT_BLOCK, /* samples of the present block */
    HYST_JOINT_THETA
};

/* Offsets of the arrays in the state, and its length. */
typedef struct {
    size_t m;
    size_t theta, d, u;  /* parameters and factors of their covariance */
    size_t z, side, age; /* memory, envelope left last (+1 upper, -1 lower), samples since it changed */
    size_t home, far;    /* input at which a play left its envelope, and the farthest one since */
    size_t psi, scratch; /* gradient of y; scratch */
    size_t length;
} hyst_joint_layout;

hyst_joint_layout hyst_joint_places(const hyst_joint *joint);

/* Sets the whole state but theta and z, which the caller has written: the parameters to start from
 * and the memory that goes with them. noise: variance of y to start from. */
void hyst_joint_start(const hyst_joint *joint, hyst_real *state, hyst_real noise);

typedef enum { HYST_JOINT_UPDATED, HYST_JOINT_WAS_SKIPPED, HYST_JOINT_WAS_REFUSED } hyst_joint_end;

/* One sample of input and measured output. */
hyst_joint_end hyst_joint_step(const hyst_joint *joint, hyst_real *state, hyst_real u, hyst_real y);

/* The input for which the estimate, with the memory it has, predicts y_ref: the exact inverse of
 * S1 eqs. 7-8 with the constants and the memory that belong to the present parameters, so that a
 * command never jumps for any other reason than what has been learnt. Does not change the state.
 * 12 operations for each play. */
hyst_real hyst_joint_command(const hyst_joint *joint, const hyst_real *state, hyst_real y_ref);

#ifdef HYST_EXTERN_C
}
#endif

#endif
