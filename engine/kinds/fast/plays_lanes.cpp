// What time lanes and the memory curve need of plays.
#include "../../simd/kernels.hpp"
#include "hyst/rate_dependent_prandtl_ishlinskii.h"
#include "plays.hpp"

namespace hyst {
namespace {

using kinds::Plays;

double threshold_of(const void *r) { return *static_cast<const double *>(r); }
bool is_not_negative(const void *r) { return threshold_of(r) >= 0.0; }
std::size_t one(const void *) { return 1; }
const hyst_pi *none(const void *) { return nullptr; }

void jump_play(const void *r, double *state, const double *u, std::size_t samples) {
    const double threshold = threshold_of(r);
    kernels().pi_jump(u, samples, 1, &threshold, state, nullptr);
}

template <bool is_stop>
bool run_play(const void *r, double *packed, const double *u, double *y, std::size_t samples,
              std::size_t stride) {
    return kernels().play_lanes(threshold_of(r), is_stop, u, y, samples, stride, packed);
}

bool ascends_from_zero(const hyst_pi &pi) {
    double before = 0.0;
    for (std::size_t i = 0; i < pi.count; ++i) {
        if (!(pi.r[i] >= before)) return false;
        before = pi.r[i];
    }
    return pi.count > 0;
}

const hyst_pi *bank_of(const void *bank) { return static_cast<const hyst_pi *>(bank); }
bool bank_ascends(const void *bank) { return ascends_from_zero(*bank_of(bank)); }
std::size_t plays_of_bank(const void *bank) { return bank_of(bank)->count; }

void jump_bank(const void *bank, double *state, const double *u, std::size_t samples) {
    const hyst_pi &pi = *bank_of(bank);
    kernels().pi_jump(u, samples, pi.count, pi.r, state, nullptr);
}

bool run_bank(const void *bank, double *packed, const double *u, double *y, std::size_t samples,
              std::size_t stride) {
    return kernels().pi_lanes(*bank_of(bank), u, y, samples, stride, packed);
}

const hyst_rate_dependent_pi &rated(const void *model) {
    return *static_cast<const hyst_rate_dependent_pi *>(model);
}
bool rated_ascends(const void *model) { return ascends_from_zero(rated(model).pi); }
std::size_t plays_of_rated(const void *model) { return rated(model).pi.count; }

void jump_rated(const void *of, double *state, const double *u, std::size_t samples) {
    const hyst_rate_dependent_pi &model = rated(of);
    double *last = state + model.pi.count;  // the previous input, and whether there is one
    kernels().rate_dependent_pi_jump(model, last[1] > 0.0 ? last[0] : u[0], u, samples, state);
    last[0] = u[samples - 1];
    last[1] = 1.0;
}

bool run_rated(const void *of, double *packed, const double *u, double *y, std::size_t samples,
               std::size_t stride) {
    const hyst_rate_dependent_pi &model = rated(of);
    const Kernels &fast = kernels();
    double *previous = packed + model.pi.count * fast.width;
    const double *exists = previous + fast.width;
    for (std::size_t lane = 0; lane < fast.width; ++lane) {
        if (!(exists[lane] > 0.0)) previous[lane] = u[lane * stride];
    }
    return fast.rate_dependent_pi_lanes(model, previous, u, y, samples, stride, packed);
}

}  // namespace

const Plays lanes_of_play{is_not_negative, one, jump_play, run_play<false>, none};
const Plays lanes_of_stop{is_not_negative, one, jump_play, run_play<true>, none};
const Plays lanes_of_pi{bank_ascends, plays_of_bank, jump_bank, run_bank, bank_of};
const Plays lanes_of_rate_dependent_pi{rated_ascends, plays_of_rated, jump_rated, run_rated, none};

}  // namespace hyst
