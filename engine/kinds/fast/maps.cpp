// Derivatives of maps, and whole records of maps by kernels.
#include "maps.hpp"

#include "../../simd/kernels.hpp"
#include "hyst/affine.h"
#include "hyst/dead_zone.h"

namespace hyst {
namespace {

// Value and slope of one dead-zone term, and its derivative by the threshold.
struct Term {
    double value;
    double slope;
    double by_threshold;
};

Term two_sided(double u, double rho) {
    if (rho == 0.0) return {u, 1.0, 0.0};
    const bool active = rho > 0.0 ? u > rho : u < rho;
    return active ? Term{u - rho, 1.0, -1.0} : Term{0.0, 0.0, 0.0};
}

Term by_direction(double u_previous, double u, double rho) {
    if (u > u_previous && u > rho) return {u - rho, 1.0, -1.0};
    if (u < u_previous && u < -rho) return {u + rho, 1.0, 1.0};
    return {0.0, 0.0, 0.0};
}

void differentiate(const hyst_dead_zone &map, const double *u_previous, const Tangents &t) {
    double before = u_previous ? *u_previous : 0.0;
    for (std::size_t k = 0; k < t.samples; ++k) {
        const double u = t.signal[k];
        double y = 0.0, slope = 0.0;
        for (std::size_t i = 0; i < map.count; ++i) {
            const double rho = map.threshold[i];
            const Term term = u_previous ? by_direction(before, u, rho) : two_sided(u, rho);
            y += map.weight[i] * term.value;
            slope += map.weight[i] * term.slope;
            t.own(k)[i] = term.value;
            t.own(k)[map.count + i] = map.weight[i] * term.by_threshold;
        }
        t.scale(k, slope);
        t.signal[k] = y;
        before = u;
    }
}

const hyst_dead_zone &dead_zone_of(const void *model) {
    return *static_cast<const hyst_dead_zone *>(model);
}

}  // namespace

void affine_jacobian(const void *model, double, const double *, const Tangents &t) {
    const hyst_affine &map = *static_cast<const hyst_affine *>(model);
    for (std::size_t k = 0; k < t.samples; ++k) {
        t.scale(k, map.gain);
        t.own(k)[0] = t.signal[k];
        t.own(k)[1] = 1.0;
        t.signal[k] = map.gain * t.signal[k] + map.offset;
    }
}

void dead_zone_jacobian(const void *model, double, const double *, const Tangents &t) {
    differentiate(dead_zone_of(model), nullptr, t);
}

void direction_dead_zone_jacobian(const void *model, double, const double *state,
                                  const Tangents &t) {
    differentiate(dead_zone_of(model), state, t);
}

void run_affine(const void *model, double *, const double *u, double *y, std::size_t samples) {
    const hyst_affine &map = *static_cast<const hyst_affine *>(model);
    kernels().affine(map.gain, map.offset, u, y, samples);
}

void run_dead_zone(const void *model, double *, const double *u, double *y, std::size_t samples) {
    kernels().dead_zone(dead_zone_of(model), u, y, samples);
}

}  // namespace hyst
