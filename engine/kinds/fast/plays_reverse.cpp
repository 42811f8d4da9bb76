// Plays on the way back. What comes to a play while it rests waits there, and goes to the sample that
// pushed it last: so the contact-sample rule of plays_jacobian.cpp, from the other end. How a play was
// pushed is read from its memories, of which no more than a block is stored.
#include <algorithm>
#include <vector>

#include "hyst/play.h"
#include "plays.hpp"

namespace hyst {
namespace {

// A bank going back through one block after another, the last first.
class BackThroughPlays {
public:
    BackThroughPlays(const hyst_pi &pi, const Cotangents &given)
        : pi_(pi), given_(given), rows_((given.block + 1) * pi.count),
          for_u_(pi.count, 0.0), for_r_(for_u_), by_p_(for_u_), by_r_(for_u_),
          passed_(for_u_) {}

    void back() {
        for (std::size_t b = given_.blocks(); b-- > 0;) {
            follow(b);
            for (std::size_t k = given_.end(b); k-- > b * given_.block;) {
                back_through(given_.u[k], given_.signal[k], &rows_[(k - b * given_.block) * pi_.count]);
                given_.signal[k] = by_u_;
            }
        }
    }

    double by_p0() const { return by_p0_; }
    double by_p(std::size_t i) const { return by_p_[i]; }
    double by_r(std::size_t i) const { return by_r_[i]; }

private:
    // The memories before and after every sample of the block.
    void follow(std::size_t b) {
        const std::size_t first = b * given_.block, n = pi_.count;
        std::copy(given_.states + b * n, given_.states + (b + 1) * n, rows_.begin());
        for (std::size_t k = first; k < given_.end(b); ++k) {
            const double u = given_.u[k], *__restrict r = pi_.r, *before = &rows_[(k - first) * n];
            double *__restrict after = &rows_[(k - first + 1) * n];
            for (std::size_t i = 0; i < n; ++i) after[i] = hyst_play(u, r[i], before[i]);
        }
    }

    // before: the memories before the sample; those after it follow. Branches are written as choices, and
    // nothing overlaps, so that plays go side by side.
    void back_through(double u, double by_y, const double *before) {
        const std::size_t n = pi_.count;
        const double *__restrict was = before, *__restrict is = before + n;
        const double *__restrict p = pi_.p, *__restrict r = pi_.r;
        double *__restrict for_u = for_u_.data(), *__restrict for_r = for_r_.data();
        double *__restrict by_p = by_p_.data(), *__restrict by_r = by_r_.data();
        double *__restrict passed = passed_.data();
        by_p0_ += by_y * u;
        for (std::size_t i = 0; i < n; ++i) {
            const double added = by_y * p[i], moved = is[i] - was[i];
            const double to_u = for_u[i] + added, to_r = for_r[i] + added;
            by_p[i] += by_y * is[i];
            by_r[i] += (moved < 0.0 ? to_r : 0.0) - (moved > 0.0 ? to_r : 0.0);
            for_r[i] = moved == 0.0 ? to_r : 0.0;
            // A play of threshold 0 never rests, but which way it went last is remembered.
            const double rest = r[i] > 0.0 ? to_u : 0.0;
            for_u[i] = moved == 0.0 ? rest : 0.0;
            passed[i] = moved == 0.0 ? to_u - rest : to_u;
        }
        double sums[4] = {pi_.p0 * by_y, 0.0, 0.0, 0.0};
        for (std::size_t i = 0; i < n; ++i) sums[i % 4] += passed[i];
        by_u_ = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    }

    const hyst_pi &pi_;
    const Cotangents &given_;
    std::vector<double> rows_, for_u_, for_r_, by_p_, by_r_, passed_;  // what waits for which, and what arrived
    double by_p0_ = 0.0, by_u_ = 0.0;
};

void back_through_one(double p0, double p, const void *r, const Cotangents &given) {
    const hyst_pi pi{1, p0, &p, static_cast<const double *>(r)};
    BackThroughPlays plays(pi, given);
    plays.back();
    given.by_constants[0] = plays.by_r(0);
}

}  // namespace

void play_reverse(const void *r, const Cotangents &given) { back_through_one(0.0, 1.0, r, given); }

void stop_reverse(const void *r, const Cotangents &given) { back_through_one(1.0, -1.0, r, given); }

void pi_reverse(const void *bank, const Cotangents &given) {
    const hyst_pi &pi = *static_cast<const hyst_pi *>(bank);
    BackThroughPlays plays(pi, given);
    plays.back();
    given.by_constants[0] = plays.by_p0();
    for (std::size_t i = 0; i < pi.count; ++i) given.by_constants[1 + i] = plays.by_p(i);
    for (std::size_t i = 0; i < pi.count; ++i) given.by_constants[1 + pi.count + i] = plays.by_r(i);
}

}  // namespace hyst
