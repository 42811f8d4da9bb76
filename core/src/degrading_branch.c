/* Branches of Bouc-Wen's model that degrades and pinches. */
#include "hyst/degrading_branch.h"

#include "hyst/power.h"

#define DEGRADING_SLOPES 11u
#define DEGRADING_LOG2_E HYST_REAL(1.4426950408889634)

/* Of a node's width: the least next to v = 0, whose kink is of order n + 1 in it. */
#define DEGRADING_LEAST HYST_REAL(0.0001220703125)

static const hyst_real degrading_rows[DEGRADING_SLOPES - 1u][DEGRADING_SLOPES - 1u] = {
    {HYST_REAL(0.5)},
    {HYST_REAL(0.25), HYST_REAL(0.25)},
    {HYST_REAL(0.14285714285714285), HYST_REAL(-0.2117115008659951),
     HYST_REAL(0.8961811933628409)},
    {HYST_REAL(0.18550685351137905), HYST_REAL(0.0), HYST_REAL(0.5766714726956089),
     HYST_REAL(0.06514850914700064)},
    {HYST_REAL(0.19963699364491333), HYST_REAL(0.0), HYST_REAL(0.3772937693043289),
     HYST_REAL(-0.46345538964060623), HYST_REAL(0.386524626691364)},
    {HYST_REAL(0.1289862929772419), HYST_REAL(0.0), HYST_REAL(-0.03302551131448482),
     HYST_REAL(-0.3497052863177422), HYST_REAL(0.32851721314173715),
     HYST_REAL(0.09790045615925942)},
    {HYST_REAL(0.07142857142857142), HYST_REAL(0.0), HYST_REAL(0.0), HYST_REAL(0.0),
     HYST_REAL(0.0020021659931149204), HYST_REAL(-0.011868683886786031),
     HYST_REAL(0.1111111111111111)},
    {HYST_REAL(0.03125), HYST_REAL(0.0), HYST_REAL(0.0), HYST_REAL(0.0),
     HYST_REAL(-0.009086961100820556), HYST_REAL(0.1527777777777778),
     HYST_REAL(-0.6325461606959097), HYST_REAL(0.9576053440189525)},
    {HYST_REAL(0.07142857142857142), HYST_REAL(0.0), HYST_REAL(0.0), HYST_REAL(0.0),
     HYST_REAL(0.1111111111111111), HYST_REAL(-0.6379313501852646), HYST_REAL(2.031083139166862),
     HYST_REAL(-1.8108630829377543), HYST_REAL(1.0624984467704635)},
    {HYST_REAL(0.0), HYST_REAL(0.0), HYST_REAL(0.0), HYST_REAL(0.0),
     HYST_REAL(-0.5512205630727289), HYST_REAL(2.451380432416967), HYST_REAL(-7.164951553231382),
     HYST_REAL(7.553840442120271), HYST_REAL(-2.2291582101947447), HYST_REAL(0.9401094519616178)},
};

static hyst_real degrading_pinched(const hyst_degrading *of, hyst_degrading_point at, hyst_real nu)
{
    const hyst_real one = HYST_REAL(1.0);
    const hyst_real first = of->zeta * (one - hyst_exp2(-DEGRADING_LOG2_E * of->p * at.energy));
    const hyst_real width = (of->psi + of->delta_psi * at.energy) * (of->lambda + first);
    const hyst_real place = of->q * hyst_power(nu, -one / of->exponent);
    const hyst_real off = (at.share - place) / width;
    return one - first * hyst_exp2(-DEGRADING_LOG2_E * off * off);
}

hyst_degrading_point hyst_degrading_slope(const hyst_degrading *of, hyst_degrading_point at)
{
    const hyst_real zero = HYST_REAL(0.0), one = HYST_REAL(1.0);
    const hyst_real nu = one + of->delta_nu * at.energy;
    const hyst_real eta = one + of->delta_eta * at.energy;
    const hyst_real held = at.share < zero ? -of->ratio * hyst_power(-at.share, of->exponent)
                                           : hyst_power(at.share, of->exponent);
    hyst_degrading_point slope;
    slope.share = (one - nu * held) / eta;
    if (of->zeta > zero) {
        slope.share = slope.share * degrading_pinched(of, at, nu);
    }
    slope.energy = at.share;
    return slope;
}

static hyst_degrading_point degrading_moved(hyst_degrading_point at, hyst_degrading_point slope,
                                            hyst_real way)
{
    at.share = at.share + way * slope.share;
    at.energy = at.energy + way * slope.energy;
    return at;
}

hyst_degrading_point hyst_degrading_advance(const hyst_degrading *of, hyst_degrading_point at,
                                            hyst_real way)
{
    hyst_degrading_point k[DEGRADING_SLOPES];
    k[0] = hyst_degrading_slope(of, at);
    for (size_t i = 1; i < DEGRADING_SLOPES; ++i) {
        hyst_degrading_point sum = {HYST_REAL(0.0), HYST_REAL(0.0)};
        for (size_t j = 0; j < i; ++j) {
            sum = degrading_moved(sum, k[j], degrading_rows[i - 1u][j]);
        }
        k[i] = hyst_degrading_slope(of, degrading_moved(at, sum, way));
    }
    hyst_degrading_point sum = {HYST_REAL(0.0), HYST_REAL(0.0)};
    sum = degrading_moved(sum, k[0], HYST_REAL(0.05));
    sum = degrading_moved(sum, k[7], HYST_REAL(0.2722222222222222));
    sum = degrading_moved(sum, k[8], HYST_REAL(0.35555555555555557));
    sum = degrading_moved(sum, k[9], HYST_REAL(0.2722222222222222));
    sum = degrading_moved(sum, k[10], HYST_REAL(0.05));
    return degrading_moved(at, sum, way);
}

/* An eighth over how quickly anything changes. */
static hyst_real degrading_width(const hyst_degrading *of, hyst_degrading_point at)
{
    const hyst_real zero = HYST_REAL(0.0), one = HYST_REAL(1.0);
    const hyst_real nu = one + of->delta_nu * at.energy;
    const hyst_real steep =
        at.share < zero ? HYST_SELECT(of->ratio > one, of->ratio, one) : one;
    hyst_real rate = of->exponent * steep * hyst_power(nu, one / of->exponent);
    if (of->zeta > zero) {
        const hyst_real first = of->zeta * (one - hyst_exp2(-DEGRADING_LOG2_E * of->p * at.energy));
        const hyst_real wide = (of->psi + of->delta_psi * at.energy) * (of->lambda + first);
        rate = rate + (one + steep) / wide + of->p;
    }
    rate = rate / (one + of->delta_eta * at.energy) + of->delta_nu + of->delta_eta;
    return HYST_REAL(0.125) / rate;
}

hyst_real hyst_degrading_next(const hyst_degrading *of, hyst_degrading_point at,
                              hyst_degrading_point *next)
{
    const hyst_real zero = HYST_REAL(0.0);
    const hyst_real width = degrading_width(of, at);
    const hyst_real least = DEGRADING_LEAST * width;
    const hyst_real slope = hyst_degrading_slope(of, at).share;
    hyst_real way = width;
    if (at.share < zero) {
        const hyst_real half = HYST_REAL(-0.5) * at.share / slope;
        if (half < least) {
            const hyst_real far = HYST_REAL(4.0) * least;
            way = hyst_degrading_root(of, at, zero, zero, far);
            *next = hyst_degrading_advance(of, at, way);
            next->share = zero;
            return way;
        }
        way = HYST_SELECT(half < width, half, width);
    } else if (slope > zero) {
        const hyst_real twice = at.share / slope + least;
        way = HYST_SELECT(twice < width, twice, width);
    }
    *next = hyst_degrading_advance(of, at, way);
    return way;
}
