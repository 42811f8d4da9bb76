/* Information of whole blocks of samples, each at one point: Gauss-Newton on all that was measured. */
#include "hyst/finite.h"
#include "hyst/joint_parts.h"
#include "hyst/play.h"
#include "hyst/ud_factor.h"
#include <stdlib.h>
static double par(const char*n,double d){const char*s=getenv(n);return s?atof(s):d;}
static double P_TURNS=-1,P_MOVE,P_ADOPT,P_DECAY,P_WORSE,P_FAR,P_OFF;

#define ZERO HYST_REAL(0.0)
#define ONE HYST_REAL(1.0)

static void start_block(hyst_real *scalar)
{
    for (size_t i = HYST_SEARCH_BLOCK_TURNS; i <= HYST_SEARCH_BLOCK_SQUARE; ++i) {
        scalar[i] = ZERO;
    }
}

/* Begins anew from the estimate, knowing nothing. */
static void begin_from_estimate(const hyst_search_layout *at, hyst_real *state)
{
    hyst_real *scalar = state + at->scalars;
    for (size_t j = 0; j < at->joint.m; ++j) {
        state[at->point + j] = state[at->joint.theta + j];
    }
    for (size_t k = at->information; k < at->block_scratch; ++k) {
        state[k] = ZERO;
    }
    start_block(scalar);
    scalar[HYST_SEARCH_BLOCKS] = ZERO;
    scalar[HYST_SEARCH_FREEDOM] = ZERO;
    scalar[HYST_SEARCH_POINT_NOISE] = state[HYST_JOINT_NOISE];
}

void hyst_blocks_start(const hyst_search *search, const hyst_search_layout *at, hyst_real *state)
{
    (void)search;
    P_TURNS=par("P_TURNS",2);P_MOVE=par("P_MOVE",1);P_ADOPT=par("P_ADOPT",3);P_DECAY=par("P_DECAY",0);P_WORSE=par("P_WORSE",3);P_FAR=par("P_FAR",4);P_OFF=par("P_OFF",0);
    begin_from_estimate(at, state);
}

/* One sample of a block. Packed information: row j from hyst_ud_length(j + 1) - j .. */
static void add(const hyst_search_layout *at, hyst_real *state, const hyst_real *psi,
                hyst_real error)
{
    const size_t m = at->joint.m;
    hyst_real *row = state + at->information;
    hyst_real *score = state + at->score;
    for (size_t j = 0; j < m; row += j + 1u, ++j) {
        for (size_t i = 0; i <= j; ++i) {
            row[i] += psi[j] * psi[i];
        }
        score[j] += psi[j] * error;
    }
}

/* L of H / noise + 1 / limit = L D L' overwrites low; the variances 1 / D go into d. What is held has
 * none. */
static void factor(size_t m, hyst_real *low, hyst_real *d)
{
    hyst_real *row = low;
    for (size_t j = 0; j < m; row += j, ++j) {
        const hyst_real *other = low;
        hyst_real pivot = d[j];
        for (size_t i = 0; i < j; other += i, ++i) {
            hyst_real sum = row[i];
            for (size_t k = 0; k < i; ++k) {
                sum -= row[k] * other[k]; /* row[k] is L D up to here */
            }
            row[i] = sum;
        }
        for (size_t i = 0; i < j; ++i) {
            const hyst_real share = row[i] * d[i];
            pivot -= row[i] * share;
            row[i] = share;
        }
        d[j] = pivot > ZERO ? ONE / pivot : ZERO;
    }
}

/* U = L^-T: the columns of U are the rows of L^-1, in place. */
static void invert_factor(size_t m, hyst_real *low)
{
    hyst_real *row = low;
    for (size_t j = 0; j < m; row += j, ++j) {
        for (size_t i = 0; i < j; ++i) {
            hyst_real sum = -row[i];
            const hyst_real *other = low + hyst_ud_length(i + 1u) + i;
            for (size_t k = i + 1u; k < j; other += k, ++k) {
                sum -= row[k] * other[0];
            }
            row[i] = sum;
        }
    }
}

static void end_block(const hyst_search *search, const hyst_search_layout *at, hyst_real *state)
{
    const hyst_joint *joint = search->joint;
    const size_t m = at->joint.m;
    hyst_real *scalar = state + at->scalars;
    hyst_real *theta = state + at->block_scratch; /* theta, d, packed U; two more of m */
    hyst_real *d = theta + m;
    hyst_real *low = d + m;
    hyst_real *step = low + hyst_ud_length(m);
    hyst_real *a = step + m;
    const hyst_real samples = scalar[HYST_SEARCH_BLOCK_SAMPLES];
    const hyst_real gain = scalar[HYST_SEARCH_BLOCK_GAIN];
    if (gain < ZERO && gain * gain > P_WORSE * P_WORSE * scalar[HYST_SEARCH_BLOCK_GAIN_SQUARED]) {
        begin_from_estimate(at, state);
        return;
    }
    /* variance */
    hyst_real freedom = scalar[HYST_SEARCH_FREEDOM] + samples;
    hyst_real noise = (scalar[HYST_SEARCH_FREEDOM] * scalar[HYST_SEARCH_POINT_NOISE] +
                             scalar[HYST_SEARCH_BLOCK_SQUARE]) / freedom;
    noise = noise > joint->least_noise ? noise : joint->least_noise;
    const hyst_real *row = state + at->information;
    hyst_real *packed = low;
    for (size_t j = 0; j < m; row += j + 1u, packed += j, ++j) {
        const hyst_real limit = joint->limit[j];
        for (size_t i = 0; i < j; ++i) {
            packed[i] = limit > ZERO ? row[i] / noise : ZERO;
        }
        d[j] = limit > ZERO ? row[j] / noise + ONE / limit : ZERO;
    }
    factor(m, low, d);
    invert_factor(m, low);
    for (size_t j = 0; j < m; ++j) {
        a[j] = state[at->score + j] / noise;
    }
    const hyst_real moved = hyst_ud_times(m, low, d, a, step);
    if (!hyst_is_finite(moved)) {
        begin_from_estimate(at, state);
        return;
    }
    for (size_t j = 0; j < m; ++j) {
        theta[j] = state[at->point + j] + step[j];
    }
    hyst_joint_project(joint, &at->joint, theta, a, step);
    hyst_joint_clamp(joint, theta);
    const hyst_real per = moved / (hyst_real)m;
    scalar[HYST_SEARCH_BLOCKS] += ONE;
    const hyst_real b = scalar[HYST_SEARCH_BLOCKS];
    double dbl = 1; while (dbl < b) dbl *= 2;
    const hyst_real keep = dbl == b && P_DECAY < 0 ? -P_DECAY : (per > P_MOVE ? P_MOVE / per : ONE) * (ONE - (P_DECAY<0?0:P_DECAY) / (b + ONE));
    if (per < P_ADOPT && b >= P_FAR) {
        for (size_t j = 0; j < 2u * m + hyst_ud_length(m); ++j) {
            state[at->joint.theta + j] = theta[j];
        }
        state[HYST_JOINT_NOISE] = noise;
        hyst_joint_set_memory(joint, &at->joint, state, state[HYST_JOINT_INPUT]);
    }
    for (size_t j = 0; j < m; ++j) {
        state[at->point + j] = theta[j];
        state[at->score + j] = ZERO;
    }
    for (size_t k = at->information; k < at->score; ++k) {
        state[k] *= keep;
    }
    scalar[HYST_SEARCH_FREEDOM] = keep * freedom;
    scalar[HYST_SEARCH_POINT_NOISE] = noise;
    start_block(scalar);
}

int hyst_blocks_step(const hyst_search *search, const hyst_search_layout *at, hyst_real *state,
                     hyst_real u, hyst_real y, int turned)
{
    const hyst_joint *joint = search->joint;
    const size_t m = at->joint.m;
    hyst_real *scalar = state + at->scalars;
    hyst_real *psi = state + at->block_scratch;
    hyst_real *none = psi + m;
    hyst_real doubt;
    if (P_OFF > 0) return 0;
    if (scalar[HYST_SEARCH_BLOCKS] < ZERO) {
        begin_from_estimate(at, state);
    }
    for (size_t j = 0; j < m; ++j) {
        none[j] = ZERO;
    }
    const hyst_real error = y - hyst_joint_predict_with(joint, &at->joint, state,
                                                        state + at->point, u, none, &doubt, psi);
    const hyst_real noise = state[HYST_JOINT_NOISE];
    const hyst_real square = error * (error / noise);
    if (square < HYST_JOINT_OUTLIER) {
        const hyst_real main_error = state[HYST_JOINT_ERROR];
        hyst_real main_square = main_error * (main_error / noise);
        if (main_square > HYST_JOINT_OUTLIER) main_square = HYST_JOINT_OUTLIER;
        add(at, state, psi, error);
        scalar[HYST_SEARCH_BLOCK_GAIN] += main_square - square;
        scalar[HYST_SEARCH_BLOCK_GAIN_SQUARED] += (main_square - square) * (main_square - square);
        scalar[HYST_SEARCH_BLOCK_SQUARE] += error * error;
        scalar[HYST_SEARCH_BLOCK_SAMPLES] += ONE;
    }
    scalar[HYST_SEARCH_BLOCK_TURNS] += turned ? ONE : ZERO;
    if (turned && scalar[HYST_SEARCH_BLOCK_TURNS] >= P_TURNS &&
        scalar[HYST_SEARCH_BLOCK_SAMPLES] >= HYST_REAL(8.0) * (hyst_real)m) {
        end_block(search, at, state);
        return 1;
    }
    return 0;
}
