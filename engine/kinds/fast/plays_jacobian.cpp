// The derivative of a play is remembered like the play itself (contact-sample rule):
// while z is pushed, z = u -+ r, so dz = du -+ dr; while it rests, dz is what it was at the
// last sample that pushed it. So each stage keeps one tangent per play and incoming parameter.
#include <algorithm>
#include <vector>

#include "../../records/evaluation.hpp"
#include "../../simd/kernels.hpp"
#include "bank_sum.hpp"
#include "hyst/play.h"
#include "plays.hpp"

namespace hyst {
namespace {

// One play with the derivatives it remembers: by its threshold and by every incoming parameter.
struct RememberingPlay {
    double z;
    double by_r = 0.0;
    std::vector<double> by_input;

    RememberingPlay(double start, std::size_t incoming) : z(start), by_input(incoming, 0.0) {}

    void step(double u, double r, const double *input_tangent) {
        const double pushed = hyst_play(u, r, z);
        if (pushed != z) {
            by_r = pushed > z ? -1.0 : 1.0;
        } else if (r > 0.0) {
            return;  // resting; a play of threshold 0 never rests
        }
        by_input.assign(input_tangent, input_tangent + by_input.size());
        z = pushed;
    }
};

void play_or_stop(double r, bool is_stop, double start, const Tangents &t) {
    RememberingPlay play(start, t.incoming);
    for (std::size_t k = 0; k < t.samples; ++k) {
        const double u = t.signal[k];
        play.step(u, r, t.row(k));
        for (std::size_t c = 0; c < t.incoming; ++c) {
            double &tangent = t.row(k)[c];
            tangent = is_stop ? tangent - play.by_input[c] : play.by_input[c];
        }
        t.own(k)[0] = is_stop ? -play.by_r : play.by_r;
        t.signal[k] = is_stop ? u - play.z : play.z;
    }
}

// A bank whose input does not depend on any parameter: nothing to remember but each play's way.
void first_prandtl_ishlinskii(const hyst_pi &pi, const double *start, const Tangents &t) {
    std::vector<double> z(start, start + pi.count), direction(pi.count, 0.0);
    for (std::size_t k = 0; k < t.samples; ++k) t.own(k)[0] = t.signal[k];
    kernels().derivative_rows(pi, z.data(), direction.data(), t.signal, t.samples, t.own(0) + 1,
                              t.own(0) + 1 + pi.count, t.stride);
    std::copy(start, start + pi.count, z.begin());
    evaluate_stage(stage_of(pi), z.data(), t.signal, t.signal, t.samples, {});
}

}  // namespace

void play_jacobian(const void *r, double, const double *state, const Tangents &t) {
    play_or_stop(*static_cast<const double *>(r), false, state[0], t);
}

void stop_jacobian(const void *r, double, const double *state, const Tangents &t) {
    play_or_stop(*static_cast<const double *>(r), true, state[0], t);
}

void pi_jacobian(const void *bank, double, const double *start, const Tangents &t) {
    const hyst_pi &pi = *static_cast<const hyst_pi *>(bank);
    if (t.incoming == 0) return first_prandtl_ishlinskii(pi, start, t);
    std::vector<RememberingPlay> plays;
    for (std::size_t i = 0; i < pi.count; ++i) plays.emplace_back(start[i], t.incoming);
    for (std::size_t k = 0; k < t.samples; ++k) {
        const double u = t.signal[k];
        double *own = t.own(k);
        own[0] = u;
        for (std::size_t i = 0; i < pi.count; ++i) {
            plays[i].step(u, pi.r[i], t.row(k));
            own[1 + i] = plays[i].z;
            own[1 + pi.count + i] = pi.p[i] * plays[i].by_r;
        }
        t.scale(k, pi.p0);
        for (std::size_t c = 0; c < t.incoming; ++c) {
            for (std::size_t i = 0; i < pi.count; ++i) t.row(k)[c] += pi.p[i] * plays[i].by_input[c];
        }
        const auto product = [&](std::size_t i) { return pi.p[i] * plays[i].z; };
        t.signal[k] = bank_sum(pi.count, pi.p0 * u, product);
    }
}

}  // namespace hyst
