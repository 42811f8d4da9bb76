// The derivative of the output by a cell's mass is what of the cell is up less what is down. On a
// branch that is what it was at the branch's start, and twice the share of the cell that has turned
// since; so every reversal on the stack keeps its derivatives, and a sample costs a product for each
// cell it has turned any of. The inverse solves for the input's:
//
//     dy = dy_s + sum +-2 share dw + (u - u_s) dp0 + slope du + slope_s du_s.
#include <algorithm>
#include <vector>

#include "hyst/preisach.h"
#include "preisach.hpp"

namespace hyst {
namespace {

using Row = std::vector<double>;

double clamped(double value) { return std::min(std::max(value, 0.0), 1.0); }

double square_of_positive(double value) { return value > 0.0 ? value * value : 0.0; }

// Area of a rectangle where alpha + beta < 0.
double area_below(double a0, double a1, double b0, double b1) {
    return 0.5 * (square_of_positive(-a0 - b0) - square_of_positive(-a1 - b0) -
                  square_of_positive(-a0 - b1) + square_of_positive(-a1 - b1));
}

// Share of a cell whose relays are up when the demagnetised state has been brought to u >= 0.
double up_at_first(const hyst_preisach &model, const double *t, std::size_t i, std::size_t j,
                   double u) {
    const double height = t[i + 1] - t[i], width = t[j + 1] - t[j];
    const double reached = clamped((u - t[i]) / height);
    if (model.ridges) {
        return std::max(reached, clamped(-(t[i] + t[j]) / (height + width)));
    }
    const double from = std::max(t[i], u);
    const double left = from < t[i + 1] ? area_below(from, t[i + 1], t[j], t[j + 1]) : 0.0;
    const double cell = height * width;
    return i == j ? reached * reached + 2.0 * left / cell : reached + left / cell;
}

double slope_at(const hyst_preisach_piece &piece, double u) {
    const double e = (u - piece.from.u) / piece.width;
    return (piece.line + 2.0 * piece.square * e) / (piece.rising ? piece.width : -piece.width);
}

// Derivatives of u and y at a point, incoming columns first.
struct Derivatives {
    Row u, y;
};

class Follower {
public:
    Follower(const hyst_preisach &model, const double *state, const Tangents &t)
        : model_(model), n_(model.cells), incoming_(t.incoming),
          columns_(t.incoming + 1 + n_ * (n_ + 1) / 2), state_(state, state + length()),
          mirrored_(model.threshold, model.threshold + n_ + 1), alpha_(n_), beta_(n_),
          nothing_{Row(columns_), Row(columns_)}, last_(nothing_) {
        std::reverse(mirrored_.begin(), mirrored_.end());
        for (double &each : mirrored_) each = -each;
        const std::size_t count = hyst_preisach_reversals(&model_, state_.data());
        kept_.assign(count, nothing_);
        const double u = state_[model.inverse ? HYST_PREISACH_OUTPUT : HYST_PREISACH_INPUT];
        if (count == 0) settle(u, nullptr);
    }

    // One sample: its derivatives over those that came in; the output.
    double step(double input, double *row) {
        const std::size_t before = hyst_preisach_reversals(&model_, state_.data());
        const double output = hyst_preisach_step(&model_, state_.data(), input);
        const std::size_t count = hyst_preisach_reversals(&model_, state_.data());
        if (count > before) kept_.push_back(last_);
        kept_.resize(count);
        settle(model_.inverse ? output : input, row);
        const Row &result = model_.inverse ? last_.u : last_.y;
        std::copy(result.begin(), result.end(), row);
        return output;
    }

private:
    std::size_t length() const { return HYST_PREISACH_STACK + 2 * model_.depth; }

    // The derivatives at u on the branch that the state is on; those of the input are in `row`, or u is
    // where the operator starts, which depends on nothing.
    void settle(double u, const double *row) {
        const std::size_t count = kept_.size();
        const double *place = state_.data() + HYST_PREISACH_STACK + 2 * count;
        Row sum(columns_);
        double slope;
        if (count == 0) {
            sum[incoming_] = u;
            add_first(u, sum.data() + incoming_ + 1);
            const hyst_preisach_piece piece = hyst_preisach_to_input(&model_, nullptr, u);
            slope = slope_at(piece, u);
        } else {
            const hyst_preisach_point start{place[-2], place[-1]}, here{u, 0.0};
            const Derivatives &from = kept_.back();
            const double back = slope_at(hyst_preisach_to_input(&model_, &here, start.u), start.u);
            slope = slope_at(hyst_preisach_to_input(&model_, &start, u), u);
            for (std::size_t c = 0; c < columns_; ++c) sum[c] = from.y[c] - back * from.u[c];
            sum[incoming_] += u - start.u;
            add_turned(start.u, u, sum.data() + incoming_ + 1);
        }
        Row given(columns_);
        if (row != nullptr) std::copy(row, row + incoming_, given.begin());
        if (!model_.inverse || row == nullptr) {
            for (std::size_t c = 0; c < incoming_; ++c) sum[c] += slope * given[c];
            last_ = {std::move(given), std::move(sum)};
        } else {
            for (std::size_t c = 0; c < columns_; ++c) {
                const double resting = count == 0 ? 0.0 : kept_.back().u[c];
                sum[c] = slope > 0.0 ? (given[c] - sum[c]) / slope : resting;
            }
            last_ = {std::move(sum), std::move(given)};
        }
    }

    void add_first(double u, double *by_mass) const {
        const bool is_mirrored = u < 0.0;
        const double *t = is_mirrored ? mirrored_.data() : model_.threshold;
        for (std::size_t i = 0; i < n_; ++i) {
            for (std::size_t j = 0; j <= i; ++j, ++by_mass) {
                const double up = is_mirrored
                                      ? 1.0 - up_at_first(model_, t, n_ - 1 - j, n_ - 1 - i, -u)
                                      : up_at_first(model_, t, i, j, u);
                *by_mass = 2.0 * up - 1.0;
            }
        }
    }

    // Twice the share of each cell between both ends of a branch.
    void add_turned(double from, double to, double *by_mass) {
        const double low = std::min(from, to), high = std::max(from, to);
        const double sign = from < to ? 2.0 : -2.0;
        const double *t = model_.threshold;
        for (std::size_t i = 0; i < n_; ++i) {
            alpha_[i] = clamped((high - t[i]) / (t[i + 1] - t[i]));
            beta_[i] = clamped((t[i + 1] - low) / (t[i + 1] - t[i]));
        }
        for (std::size_t i = 0; i < n_; by_mass += ++i) {
            if (!(alpha_[i] > 0.0) || !(beta_[i] > 0.0)) continue;
            const double line = std::max(alpha_[i] + beta_[i] - 1.0, 0.0);
            if (model_.ridges) {
                for (std::size_t j = 0; j < i; ++j) {
                    by_mass[j] += sign * std::max(alpha_[i] + beta_[j] - 1.0, 0.0);
                }
                by_mass[i] += sign * line;
            } else {
                const double part = sign * alpha_[i];
                for (std::size_t j = 0; j < i; ++j) by_mass[j] += part * beta_[j];
                by_mass[i] += sign * (line * line);
            }
        }
    }

    const hyst_preisach &model_;
    const std::size_t n_, incoming_, columns_;
    Row state_, mirrored_, alpha_, beta_;
    std::vector<Derivatives> kept_;  // of the reversals on the stack
    const Derivatives nothing_;
    Derivatives last_;
};

}  // namespace

void preisach_jacobian(const void *of, double, const double *state, const Tangents &t) {
    Follower follower(*static_cast<const hyst_preisach *>(of), state, t);
    for (std::size_t k = 0; k < t.samples; ++k) {
        t.signal[k] = follower.step(t.signal[k], t.row(k));
    }
}

}  // namespace hyst
