/* Scale and offset of the output of any model, estimated sample by sample.
 *
 *   y = scale w + offset + noise,  w what the model gives for the input.
 *
 * Least squares with forgetting, in centred sums: with d = w - mean(w) before the sample, and a the
 * weight of the sample in the means,
 *   cww += (1 - a) d^2,  cwy += (1 - a) d (y - mean(y)),  slope = cwy / cww.
 * The means forget always, for an offset may drift while the actuator rests; cww and cwy do not
 * while it rests, or they would forget what nothing tells anew. It rests while w has not moved by a
 * tenth of its standard deviation for longer than `patience` samples.
 *
 * The start counts as much as it is believed in: scale = start + share (slope - start) with share =
 * V / (V + var(slope)), V the variance of the start. Its sign is kept, and its bounds. Nothing is
 * taken from the slope before HYST_SCALE_LEAST samples.
 *
 * noise is the mean square of the recursive residuals (Brown, Durbin and Evans 1975), which are
 * white and have the variance of the noise from the second sample on if the model is right.
 * var(slope) = noise wideness sum(weights^2 d^2) / cww^2. Errors that follow each other tell less
 * than as many of noise: `wideness` is the largest ratio of the mean square of sums of 2, 4, 8 ..
 * successive d e to what it is for noise, where it is beyond doubt larger than 1; likewise with e
 * for the offset. Blocks are no longer than half of what is remembered; a ratio that still grows with
 * their length is taken to do so up to that.
 *
 * One step costs some 60 operations and 8 divisions, and on average 40 more for the sums. */
#ifndef HYST_SCALE_ESTIMATOR_H
#define HYST_SCALE_ESTIMATOR_H

#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    hyst_real forgetting; /* share of the past that a sample takes away, 0 <= forgetting < 1 */
    hyst_real patience;   /* samples */
    hyst_real spread;     /* standard error of the start over its value */
    hyst_real least;      /* bounds of the scale over the start's, 0 < least < 1 < most */
    hyst_real most;
    int scale_held;
    int offset_held;
} hyst_scale;

#define HYST_SCALE_LEVELS 16u
#define HYST_SCALE_LEAST HYST_REAL(10.0) /* samples before the noise is believed */

/* Of one length of blocks: the block that waits for its second half, and the means over blocks. */
enum {
    HYST_SCALE_WAITS,
    HYST_SCALE_SUM_SLOPE, /* sum of d e, of its squares, of e, of its squares */
    HYST_SCALE_OWN_SLOPE,
    HYST_SCALE_SUM_MEAN,
    HYST_SCALE_OWN_MEAN,
    HYST_SCALE_BLOCKS, /* in these means, and the means of sums squared and of sums of squares */
    HYST_SCALE_SQUARE_SLOPE,
    HYST_SCALE_NOISE_SLOPE,
    HYST_SCALE_SQUARE_MEAN,
    HYST_SCALE_NOISE_MEAN,
    HYST_SCALE_ONE_LEVEL
};

/* Places in the state. */
enum {
    HYST_SCALE_START, /* scale and offset to start from */
    HYST_SCALE_START_OFFSET,
    HYST_SCALE_SCALE, /* the estimate */
    HYST_SCALE_OFFSET,
    HYST_SCALE_VARIANCE,        /* of the scale */
    HYST_SCALE_MEAN_VARIANCE,   /* of mean(y); the offset's is it and mean(w)^2 times the scale's */
    HYST_SCALE_SLOPE_VARIANCE,  /* of the slope, without the start; negative if there is none */
    HYST_SCALE_ERROR,           /* of the last sample used, before it was */
    HYST_SCALE_NOISE,           /* variance */
    HYST_SCALE_NOISE_SAMPLES,   /* in its mean */
    HYST_SCALE_PRODUCT,         /* mean of residuals times the one before */
    HYST_SCALE_RESIDUAL,        /* of the last sample */
    HYST_SCALE_WIDE_SLOPE,      /* wideness, and samples in the blocks that it was found with */
    HYST_SCALE_WIDE_MEAN,
    HYST_SCALE_WIDE_SAMPLES,
    HYST_SCALE_WEIGHT, /* sum of weights, and of their squares */
    HYST_SCALE_WEIGHT_SQUARED,
    HYST_SCALE_MEAN_W,
    HYST_SCALE_MEAN_Y,
    HYST_SCALE_WW,
    HYST_SCALE_WY,
    HYST_SCALE_WW_SQUARED,
    HYST_SCALE_SLOPE_WEIGHT, /* sum of weights in cww */
    HYST_SCALE_ANCHOR, /* w where it moved last, and samples since */
    HYST_SCALE_AGE,
    HYST_SCALE_USED,
    HYST_SCALE_SKIPPED, /* not finite */
    HYST_SCALE_REFUSED, /* would overflow */
    HYST_SCALE_BLOCK
};

#define HYST_SCALE_LENGTH ((unsigned)HYST_SCALE_BLOCK + HYST_SCALE_LEVELS * (unsigned)HYST_SCALE_ONE_LEVEL)

typedef enum {
    HYST_SCALE_UPDATED,
    HYST_SCALE_WAS_SKIPPED,
    HYST_SCALE_WAS_REFUSED
} hyst_scale_end;

/* Forgets all but what was counted, and starts from a scale and an offset. */
void hyst_scale_start(const hyst_scale *scale, hyst_real *state, hyst_real start,
                      hyst_real offset);

/* One sample: the model's output and the measured one. */
hyst_scale_end hyst_scale_step(const hyst_scale *scale, hyst_real *state, hyst_real w,
                               hyst_real y);

#ifdef HYST_EXTERN_C
}
#endif

#endif
