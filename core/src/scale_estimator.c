/* Scale and offset of a model's output: one sample. */
#include "hyst/scale_estimator.h"

#include "hyst/finite.h"

#define ZERO HYST_REAL(0.0)
#define ONE HYST_REAL(1.0)
#define TWO HYST_REAL(2.0)

/* Samples in the mean of the noise; blocks in the means of their sums, and how many blocks there
 * must be before anything follows from them. */
#define SCALE_NOISE_MEMORY HYST_REAL(300.0)
#define SCALE_BLOCK_MEMORY HYST_REAL(32.0)
#define SCALE_LEAST_BLOCKS HYST_REAL(8.0)
/* The wideness is found anew whenever so many lengths of blocks are complete, every 8 samples. */
#define SCALE_SELDOM 3u
/* By how much a ratio must grow from one length of blocks to the next to be taken to go on growing,
 * which it does by 2 where errors have one sign. */
#define SCALE_GROWS HYST_REAL(1.5)
/* It moves when w goes on by a tenth of its standard deviation. */
#define SCALE_MOVED HYST_REAL(0.01)

void hyst_scale_start(const hyst_scale *scale, hyst_real *state, hyst_real start,
                      hyst_real offset)
{
    for (size_t i = 0; i < (size_t)HYST_SCALE_LENGTH; ++i) {
        if (i != (size_t)HYST_SCALE_USED && i != (size_t)HYST_SCALE_SKIPPED &&
            i != (size_t)HYST_SCALE_REFUSED) {
            state[i] = ZERO;
        }
    }
    const hyst_real width = scale->spread * start;
    state[HYST_SCALE_START] = state[HYST_SCALE_SCALE] = start;
    state[HYST_SCALE_START_OFFSET] = state[HYST_SCALE_OFFSET] = offset;
    state[HYST_SCALE_VARIANCE] = scale->scale_held ? ZERO : width * width;
    state[HYST_SCALE_SLOPE_VARIANCE] = -ONE;
    state[HYST_SCALE_WIDE_SLOPE] = state[HYST_SCALE_WIDE_MEAN] = ONE;
    state[HYST_SCALE_WIDE_SAMPLES] = ONE;
    if (scale->offset_held) {
        state[HYST_SCALE_MEAN_Y] = offset;
    }
}

/* The ratio of a sum's mean square to that of noise, where it is beyond doubt above 1. */
static hyst_real scale_ratio(hyst_real square, hyst_real noise, hyst_real blocks)
{
    const hyst_real ratio = noise > ZERO ? square / noise : ONE;
    const hyst_real above = ratio - ONE;
    /* The ratio scatters by sqrt(2 / blocks); a mean that forgets counts twice its memory. */
    const hyst_real count = blocks < SCALE_BLOCK_MEMORY ? blocks : TWO * SCALE_BLOCK_MEMORY;
    return above > ZERO && above * above * count > HYST_REAL(8.0) ? ratio : ONE;
}

/* The largest ratio so far, and whether it still grows with the length of the blocks: errors that
 * follow each other for longer than the longest blocks, as where a constant drifts. */
typedef struct {
    hyst_real widest;
    hyst_real samples;
    hyst_real last;
    int grows;
} scale_wideness;

static void scale_compare(scale_wideness *wide, hyst_real ratio, hyst_real length)
{
    wide->grows = ratio > wide->widest && ratio > SCALE_GROWS * wide->last;
    wide->last = ratio;
    if (ratio > wide->widest) {
        wide->widest = ratio;
        wide->samples = length;
    }
}

static hyst_real scale_found(const scale_wideness *wide, hyst_real times)
{
    return wide->grows ? times * wide->widest : wide->widest;
}

static void scale_widen(hyst_real *state, hyst_real remembered)
{
    scale_wideness slope = {ONE, ONE, ONE, 0};
    scale_wideness mean = {ONE, ONE, ONE, 0};
    hyst_real length = ONE;
    const hyst_real *level = state + HYST_SCALE_BLOCK;
    for (unsigned i = 0u; i < HYST_SCALE_LEVELS; ++i) {
        const hyst_real blocks = level[HYST_SCALE_BLOCKS];
        if (blocks < SCALE_LEAST_BLOCKS || TWO * TWO * length > remembered) {
            break;
        }
        length += length;
        scale_compare(&slope,
                      scale_ratio(level[HYST_SCALE_SQUARE_SLOPE], level[HYST_SCALE_NOISE_SLOPE],
                                  blocks),
                      length);
        scale_compare(&mean,
                      scale_ratio(level[HYST_SCALE_SQUARE_MEAN], level[HYST_SCALE_NOISE_MEAN],
                                  blocks),
                      length);
        level += HYST_SCALE_ONE_LEVEL;
    }
    const hyst_real times = remembered / length;
    state[HYST_SCALE_WIDE_SLOPE] = scale_found(&slope, times);
    state[HYST_SCALE_WIDE_MEAN] = scale_found(&mean, times);
    state[HYST_SCALE_WIDE_SAMPLES] = slope.widest > mean.widest ? slope.samples : mean.samples;
}

static void scale_average(hyst_real *level, size_t place, hyst_real share, hyst_real value)
{
    level[place] += share * (value - level[place]);
}

/* Two halves make a block, two blocks one of twice the length. Gives how many were completed. */
static unsigned scale_gather(hyst_real *state, hyst_real by_slope, hyst_real by_mean)
{
    hyst_real sums[4] = {by_slope, by_slope * by_slope, by_mean, by_mean * by_mean};
    hyst_real *level = state + HYST_SCALE_BLOCK;
    for (unsigned i = 0u; i < HYST_SCALE_LEVELS; ++i) {
        hyst_real *waiting = level + HYST_SCALE_SUM_SLOPE;
        if (!(level[HYST_SCALE_WAITS] > ZERO)) {
            level[HYST_SCALE_WAITS] = ONE;
            for (unsigned j = 0u; j < 4u; ++j) {
                waiting[j] = sums[j];
            }
            return i;
        }
        level[HYST_SCALE_WAITS] = ZERO;
        for (unsigned j = 0u; j < 4u; ++j) {
            sums[j] += waiting[j];
        }
        if (level[HYST_SCALE_BLOCKS] < SCALE_BLOCK_MEMORY) {
            level[HYST_SCALE_BLOCKS] += ONE;
        }
        const hyst_real share = ONE / level[HYST_SCALE_BLOCKS];
        scale_average(level, HYST_SCALE_SQUARE_SLOPE, share, sums[0] * sums[0]);
        scale_average(level, HYST_SCALE_NOISE_SLOPE, share, sums[1]);
        scale_average(level, HYST_SCALE_SQUARE_MEAN, share, sums[2] * sums[2]);
        scale_average(level, HYST_SCALE_NOISE_MEAN, share, sums[3]);
        level += HYST_SCALE_ONE_LEVEL;
    }
    return HYST_SCALE_LEVELS;
}

/* How much of the past the slope forgets: nothing while w rests. */
static hyst_real scale_forgetting(const hyst_scale *scale, hyst_real *state, hyst_real w)
{
    const hyst_real away = w - state[HYST_SCALE_ANCHOR];
    const hyst_real weight = state[HYST_SCALE_SLOPE_WEIGHT];
    if (!(weight > ZERO) || away * away * weight > SCALE_MOVED * state[HYST_SCALE_WW]) {
        state[HYST_SCALE_ANCHOR] = w;
        state[HYST_SCALE_AGE] = ZERO;
    } else if (state[HYST_SCALE_AGE] <= scale->patience) {
        state[HYST_SCALE_AGE] += ONE;
    }
    return state[HYST_SCALE_AGE] > scale->patience ? ZERO : scale->forgetting;
}

/* The estimate, from the sums. */
static void scale_estimate(const hyst_scale *scale, hyst_real *state)
{
    const hyst_real ww = state[HYST_SCALE_WW];
    const hyst_real noise = state[HYST_SCALE_NOISE];
    const hyst_real start = state[HYST_SCALE_START];
    hyst_real estimate = start;
    hyst_real variance = ZERO;
    state[HYST_SCALE_SLOPE_VARIANCE] = -ONE;
    if (!scale->scale_held) {
        const hyst_real width = scale->spread * start;
        variance = width * width;
        if (ww > ZERO && state[HYST_SCALE_NOISE_SAMPLES] > ZERO) {
            const hyst_real of_slope = state[HYST_SCALE_WIDE_SLOPE] * noise *
                                       (state[HYST_SCALE_WW_SQUARED] / ww) / ww;
            state[HYST_SCALE_SLOPE_VARIANCE] = of_slope;
            if (state[HYST_SCALE_WEIGHT] >= HYST_SCALE_LEAST ||
                state[HYST_SCALE_NOISE_SAMPLES] >= HYST_SCALE_LEAST) {
                const hyst_real share = variance / (variance + of_slope);
                estimate += share * (state[HYST_SCALE_WY] / ww - start);
                variance = share * of_slope;
            }
        }
        const hyst_real least = scale->least * start;
        const hyst_real most = scale->most * start;
        const hyst_real low = least < most ? least : most;
        const hyst_real high = least < most ? most : least;
        estimate = estimate < low ? low : (estimate > high ? high : estimate);
    }
    state[HYST_SCALE_SCALE] = estimate;
    state[HYST_SCALE_VARIANCE] = variance;
    if (!scale->offset_held) {
        const hyst_real weight = state[HYST_SCALE_WEIGHT];
        state[HYST_SCALE_OFFSET] =
            state[HYST_SCALE_MEAN_Y] - estimate * state[HYST_SCALE_MEAN_W];
        state[HYST_SCALE_MEAN_VARIANCE] = state[HYST_SCALE_WIDE_MEAN] * noise *
                                          (state[HYST_SCALE_WEIGHT_SQUARED] / weight) / weight;
    }
}

/* The noise, what follows from it, and the blocks. `reach` is by what the variance of the residual
 * exceeds that of the noise, since slope and means are estimates. */
static void scale_watch(hyst_real *state, hyst_real residual, hyst_real d, hyst_real reach,
                        hyst_real remembered)
{
    hyst_real *samples = &state[HYST_SCALE_NOISE_SAMPLES];
    if (*samples < SCALE_NOISE_MEMORY) {
        *samples += ONE;
    }
    const hyst_real share = ONE / *samples;
    const hyst_real damped = residual / reach;
    scale_average(state, HYST_SCALE_NOISE, share, residual * damped);
    scale_average(state, HYST_SCALE_PRODUCT, share, damped * state[HYST_SCALE_RESIDUAL]);
    state[HYST_SCALE_RESIDUAL] = damped;
    if (scale_gather(state, d * damped, damped) >= SCALE_SELDOM) {
        scale_widen(state, remembered);
    }
}

hyst_scale_end hyst_scale_step(const hyst_scale *scale, hyst_real *state, hyst_real w,
                               hyst_real y)
{
    if (!hyst_is_finite(w) || !hyst_is_finite(y)) {
        state[HYST_SCALE_SKIPPED] += ONE;
        return HYST_SCALE_WAS_SKIPPED;
    }
    const hyst_real d = w - state[HYST_SCALE_MEAN_W];
    const hyst_real dy = y - state[HYST_SCALE_MEAN_Y];
    const hyst_real ww = state[HYST_SCALE_WW];
    const hyst_real size = d * d + dy * dy;
    /* Squares of squares are summed over many samples, so absurd sizes are refused here. */
    if (!hyst_is_finite(HYST_REAL(1e6) * size * size)) {
        state[HYST_SCALE_REFUSED] += ONE;
        return HYST_SCALE_WAS_REFUSED;
    }
    const hyst_real seen = state[HYST_SCALE_WEIGHT];
    state[HYST_SCALE_ERROR] = y - state[HYST_SCALE_SCALE] * w - state[HYST_SCALE_OFFSET];
    const hyst_real forgotten = scale_forgetting(scale, state, w);
    const hyst_real kept = ONE - forgotten;
    const hyst_real weight = (ONE - scale->forgetting) * seen + ONE;
    hyst_real share = ZERO;
    hyst_real reach = ONE;
    if (!scale->offset_held) {
        share = ONE / weight;
        reach += seen > ZERO ? ONE / seen : ZERO;
    }
    /* A first sample has nothing to be compared with, but where the offset is held. */
    if (seen > ZERO || scale->offset_held) {
        const int known = ww > ZERO && !scale->scale_held;
        const hyst_real slope = known ? state[HYST_SCALE_WY] / ww : state[HYST_SCALE_START];
        if (known) {
            reach += d * d / ww;
        }
        /* Before w has moved it tells the noise only while it rests. */
        if (known || scale->scale_held || !(d < ZERO || d > ZERO)) {
            scale_watch(state, dy - slope * d, d, reach, weight);
        }
        const hyst_real part = ONE - share;
        state[HYST_SCALE_WW] = kept * ww + part * d * d;
        state[HYST_SCALE_WY] = kept * state[HYST_SCALE_WY] + part * d * dy;
        /* part d dy has the variance part d^2 noise, since that of dy is noise / part. */
        state[HYST_SCALE_WW_SQUARED] =
            kept * kept * state[HYST_SCALE_WW_SQUARED] + part * d * d;
    }
    state[HYST_SCALE_SLOPE_WEIGHT] = kept * state[HYST_SCALE_SLOPE_WEIGHT] + ONE;
    state[HYST_SCALE_WEIGHT] = weight;
    state[HYST_SCALE_WEIGHT_SQUARED] = (ONE - scale->forgetting) * (ONE - scale->forgetting) *
                                           state[HYST_SCALE_WEIGHT_SQUARED] + ONE;
    state[HYST_SCALE_MEAN_W] += share * d;
    state[HYST_SCALE_MEAN_Y] += share * dy;
    scale_estimate(scale, state);
    state[HYST_SCALE_USED] += ONE;
    return HYST_SCALE_UPDATED;
}
