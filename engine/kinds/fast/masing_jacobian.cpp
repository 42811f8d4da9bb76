// A branch y = y_i + 2 f((u - u_i) / 2) is differentiated through the reversal it starts at: every
// reversal on the stack is kept with the derivatives of its input and output. Which reversals there
// are is read from the core's own state after each step, so the derivative never disagrees with it.
#include <algorithm>
#include <cmath>
#include <vector>

#include "hyst/masing.h"
#include "masing.hpp"

namespace hyst {
namespace {

// Derivatives of one number: by the incoming parameters, then by the stage's own.
using Tangent = std::vector<double>;

struct Reversal {
    double input = 0.0, output = 0.0;
    Tangent by_input, by_output;
};

// Value and derivatives of the curve of the model (f, or its inverse) at one point.
struct CurvePoint {
    double slope = 0.0;
    std::vector<double> by_constant;
};

void add_power_law(const hyst_power_law &f, double x, std::vector<double> &by_constant) {
    const double unit = x > 0.0 ? std::pow(2.0 * x, f.exponent) / (2.0 * f.exponent) : 0.0;
    const double c2 = f.factor * f.exponent / std::pow(2.0, f.exponent - 1.0);
    by_constant[0] = x;
    by_constant[1] = unit;
    by_constant[2] = x > 0.0 ? c2 * unit * (std::log(2.0 * x) - 1.0 / f.exponent) : 0.0;
}

void add_pieces(const hyst_pieces &f, double x, std::vector<double> &by_constant) {
    const std::size_t plays = f.count - 1;
    by_constant[0] = x;
    for (std::size_t i = 0; i < plays; ++i) {
        const double over = x - f.knot[i + 1];
        by_constant[1 + i] = std::max(over, 0.0);
        by_constant[1 + plays + i] = over > 0.0 ? f.slope[i] - f.slope[i + 1] : 0.0;
    }
}

// f_theta(x) and f'(x).
void at_point_of_f(const hyst_loading_curve &curve, double x, CurvePoint &point) {
    switch (curve.kind) {
    case HYST_POWER_LAW:
        add_power_law(curve.as.power_law, x, point.by_constant);
        break;
    case HYST_PLAYS:
        add_pieces(curve.as.pieces, x, point.by_constant);
        break;
    case HYST_POLYNOMIAL: {
        double power = 1.0;
        for (double &each : point.by_constant) each = power *= x;
        break;
    }
    }
    point.slope = hyst_loading_slope(&curve, x);
}

// One way along the curve or the other: f, or with (f^-1)' = 1/f', (f^-1)_theta = -f_theta / f'.
void at_point(const hyst_loading_curve &curve, bool inverse, double argument, CurvePoint &point) {
    const double x = inverse ? hyst_unloading(&curve, argument) : argument;
    at_point_of_f(curve, x, point);
    if (!inverse) return;
    for (double &each : point.by_constant) each /= -point.slope;
    point.slope = 1.0 / point.slope;
}

std::size_t parameter_count(const hyst_masing &model) {
    switch (model.curve.kind) {
    case HYST_POWER_LAW:
        return 3;
    case HYST_PLAYS:
        return 2 * model.curve.as.pieces.count - 1;
    case HYST_POLYNOMIAL:
        return model.curve.as.polynomial.count;
    }
    return 0;
}

class Differentiated {
public:
    Differentiated(const hyst_masing &model, const double *state, std::size_t incoming)
        : model_(model),
          state_(state, state + hyst_masing_state_length(&model)),
          incoming_(incoming),
          width_(incoming + parameter_count(model)),
          stack_(model.depth) {
        point_.by_constant.resize(width_ - incoming);
        last_ = fresh(state_[HYST_MASING_INPUT], state_[HYST_MASING_OUTPUT]);
        for (std::size_t i = 0; i < count(); ++i) stack_[i] = fresh(stored(i)[0], stored(i)[1]);
    }

    // One sample: `tangent` holds the derivatives of the input on entry, of the output on exit.
    double step(double input, double *tangent) {
        const std::size_t before = count();
        const Reversal start = top();
        const bool had_start = before > 0;
        const double output = hyst_masing_step(&model_, state_.data(), input);
        follow_reversals(before, had_start, start);
        Reversal now = fresh(input, output);
        std::copy(tangent, tangent + incoming_, now.by_input.begin());
        now.by_output = along_branch(count() > 0, top(), now, model_.inverse, input);
        std::copy(now.by_output.begin(), now.by_output.end(), tangent);
        const bool is_extreme = state_[HYST_MASING_INPUT] == input;
        if (is_extreme) last_ = std::move(now);
        return output;
    }

private:
    Reversal fresh(double input, double output) const {
        return {input, output, Tangent(width_, 0.0), Tangent(width_, 0.0)};
    }
    std::size_t count() const { return hyst_masing_reversals(&model_, state_.data()); }
    const double *stored(std::size_t i) const { return &state_[HYST_MASING_STACK + 2 * i]; }
    Reversal top() const { return count() > 0 ? stack_[count() - 1] : fresh(0.0, 0.0); }

    // Whatever the core has put on the stack is what was last; a new place in the dead band is on
    // the branch that was left.
    void follow_reversals(std::size_t before, bool had_start, const Reversal &start) {
        const std::size_t now = count();
        if (now == 0) return;
        const double *kept = stored(now - 1);
        const bool is_new = now == before + 1 || (model_.last_reversal && now == before &&
                                                  (kept[0] != stack_[0].input ||
                                                   kept[1] != stack_[0].output));
        if (!is_new) return;
        Reversal made = last_;
        if (kept[0] != last_.input || kept[1] != last_.output) {
            made = end_of_dead_band(had_start, start, kept[0], kept[1]);
        }
        stack_[now - 1] = std::move(made);
    }

    Reversal end_of_dead_band(bool had_start, const Reversal &start, double input, double output) {
        Reversal made = fresh(input, output);
        if (!model_.inverse) {
            made.by_input = last_.by_input;
            made.by_output = along_branch(had_start, start, made, false, input);
            return made;
        }
        made.by_output = last_.by_output;
        const Reversal exchanged{start.output, start.input, start.by_output, start.by_input};
        const Reversal wanted{output, input, made.by_output, {}};
        made.by_input = along_branch(had_start, exchanged, wanted, false, output);
        return made;
    }

    Tangent along_branch(bool has_start, const Reversal &start, const Reversal &now, bool inverse,
                         double input) {
        const double along = has_start ? 0.5 * input - 0.5 * start.input : input;
        const double twice = has_start ? 2.0 : 1.0;
        at_point(model_.curve, inverse, std::abs(along), point_);
        Tangent result = start.by_output;
        for (std::size_t c = 0; c < width_; ++c) {
            result[c] += point_.slope * (now.by_input[c] - start.by_input[c]);
        }
        const double signed_twice = along < 0.0 ? -twice : twice;
        for (std::size_t j = 0; j < point_.by_constant.size(); ++j) {
            result[incoming_ + j] += signed_twice * point_.by_constant[j];
        }
        return result;
    }

    const hyst_masing &model_;
    std::vector<double> state_;
    std::size_t incoming_, width_;
    std::vector<Reversal> stack_;
    Reversal last_;
    CurvePoint point_;
};

}  // namespace

void masing_jacobian(const void *of, double, const double *state, const Tangents &t) {
    const hyst_masing &model = *static_cast<const hyst_masing *>(of);
    Differentiated stage(model, state, t.incoming);
    for (std::size_t k = 0; k < t.samples; ++k) {
        t.signal[k] = stage.step(t.signal[k], t.rows + k * t.stride);
    }
}

}  // namespace hyst
