// The core in single precision: what an exported target computes, to the last bit. A module of its
// own, because a program links the core in one precision only.
#include <nanobind/nanobind.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "hyst/hyst.h"
#include "../kinds/kind.hpp"
#include "../limited_drive.hpp"
#include "single_moving.hpp"
#include "single_stages.hpp"

namespace nb = nanobind;

namespace {

static_assert(sizeof(hyst_real) == sizeof(float), "this module is for single precision");

using hyst::single::Description;
using hyst::single::Tables;
using hyst::single::rounded;

class Stepper {
public:
    Stepper(const std::vector<Description> &stages, const std::vector<double> &start)
        : state_(start.begin(), start.end()) {
        std::size_t length = 0, forward = 0;
        for (const Description &each : stages) {
            const std::string &name = std::get<0>(each);
            if (name == "tracking_controller") {
                controls_.push_back(rounded(each));
                add_controller(controls_.back());
                length += controller_.order;
            } else if (name == "drive_limits") {
                const hyst::kinds::Constants limits = rounded(each);
                limited_.inverse.limits = {limits.number("low"), limits.number("high"),
                                           limits.number("change")};
                forward = limits.choice("forward");
                is_model_ = limits.has_choice("way") && limits.choice("way") == 0;
                length += 1;
                is_limited_ = true;
            } else if (name == "bank_limits") {
                const hyst::kinds::Constants of = rounded(each);
                const auto end = [&](const std::string &side) {
                    const auto number = [&](const char *what) {
                        return of.number((what + side).c_str());
                    };
                    return hyst_bank_end{of.choice(("moved_" + side).c_str()), number("slope_"),
                                         number("constant_"), number("from_"), number("least_")};
                };
                ends_ = {of.number("low"), of.number("high"), end("low"), end("high")};
                length += 1;
                is_limited_ = is_bank_ = true;
            } else if (name == "anti_windup") {
                controls_.push_back(rounded(each));
                limited_.w = controls_.back().table("w");
            } else if (name == "repetitive_memory" || name == "repetitive_learning") {
                controls_.push_back(rounded(each));
                remember(controls_.back(), name == "repetitive_learning");
            } else {
                add_stage(hyst::kinds::known_kind(name), rounded(each));
            }
        }
        for (const hyst_stage &each : stages_) length += hyst_stage_state_length(&each);
        if (is_repetitive_) length += hyst_repetitive_memory_length(&memory_);
        if (length != state_.size()) throw std::invalid_argument("start has the wrong length");
        controller_.inverse = {stages_.size(), stages_.data()};
        if (is_limited_) limit(forward);
    }
    Stepper(const Stepper &) = delete;
    Stepper &operator=(const Stepper &) = delete;

    double step(double u) {
        if (has_two_inputs_) throw std::invalid_argument("this block takes y_ref and y");
        if (drive_ != nullptr) {
            return drive_->step(state_.data(), before_.data(), &limited_guard_,
                                static_cast<float>(u));
        }
        return hyst_guarded_step(&controller_.inverse, state_.data(), &guard_,
                                 static_cast<float>(u));
    }
    // The next output, of which nothing is remembered; NaN if there is none.
    double peek(double u) const {
        std::vector<float> memory = state_;
        hyst_guard guard = guard_;
        guard.fault = 0;
        const double y = hyst_guarded_step(&controller_.inverse, memory.data(), &guard,
                                           static_cast<float>(u));
        return guard.fault != 0 ? std::numeric_limits<double>::quiet_NaN() : y;
    }
    double step_controller(double y_ref, double y) {
        if (!has_two_inputs_) throw std::invalid_argument("this block takes u");
        const float reference = static_cast<float>(y_ref), output = static_cast<float>(y);
        if (is_repetitive_ && is_limited_) {
            return hyst_limited_repetitive_step(&memory_, &limited_.inverse, state_.data(),
                                                before_.data(), &limited_guard_, reference, output,
                                                &v_, &changed_);
        }
        if (is_repetitive_) {
            return hyst_repetitive_step(&memory_, &controller_.inverse, state_.data(), &guard_,
                                        reference, output, &v_, &changed_);
        }
        if (is_limited_) {
            return hyst_limited_tracking_step(&limited_, state_.data(), before_.data(),
                                              &limited_guard_, reference, output, &v_, &excess_);
        }
        return hyst_guarded_tracking_step(&controller_, state_.data(), &guard_,
                                          reference, output);
    }
    std::vector<double> state() const { return {state_.begin(), state_.end()}; }
    bool fault() const { return guard_.fault != 0 || limited_guard_.guard.fault != 0; }
    bool limited() const { return limited_guard_.limited != 0; }
    void clear_fault() {
        guard_.fault = limited_guard_.guard.fault = 0;
        limited_guard_.limited = 0;
    }

private:
    // The last `forward` stages are those from the drive to v.
    void limit(std::size_t forward) {
        if (forward > stages_.size()) throw std::invalid_argument("too few stages");
        const std::size_t count = stages_.size() - forward;
        limited_.linear = controller_;
        limited_.inverse.inverse = {count, stages_.data()};
        limited_.inverse.forward = {forward, stages_.data() + count};
        before_.resize(state_.size());
        limited_guard_.guard.y_last = state_.back();
        if (has_two_inputs_) return;
        using Way = hyst::LimitedDrive::Way;
        const hyst_limited_inverse &of = limited_.inverse;
        drive_ = is_bank_
                     ? std::make_unique<hyst::LimitedDrive>(of.inverse, ends_)
                     : std::make_unique<hyst::LimitedDrive>(is_model_ ? Way::model : Way::forward,
                                                            of.inverse, of.forward, of.limits);
        limited_guard_.guard.y_last = drive_->start(state_.data());
    }

    void add_controller(const hyst::kinds::Constants &of) {
        controller_ = {of.size("c"),
                       of.table("a"),
                       of.table("b"),
                       of.table("c"),
                       {of.number("d_y_ref"), of.number("d_y")},
                       {0, nullptr}};
        has_two_inputs_ = true;
    }

    // The memory of a period comes in two parts, each with the filter that it needs.
    void remember(const hyst::kinds::Constants &of, bool learns) {
        memory_.period = of.choice("period");
        memory_.half = of.choice("half");
        memory_.lead = of.choice("lead");
        memory_.taps = of.choice("taps");
        memory_.wait = of.choice("wait");
        memory_.compares = static_cast<int>(of.choice("compares"));
        if (learns) {
            memory_.learn = of.table("learn");
        } else {
            memory_.tolerance = of.number("tolerance");
            memory_.smooth = of.table("smooth");
        }
        has_two_inputs_ = is_repetitive_ = true;
    }

    // The last stages before one that says how many are inside it are those.
    void add_stage(const hyst::kinds::Kind &kind, hyst::kinds::Constants constants) {
        const std::size_t inside = constants.has_choice("inside") ? constants.choice("inside") : 0;
        if (inside > made_.size()) throw std::invalid_argument("too few stages before '" +
                                                              std::string(kind.name) + "'");
        const std::size_t kept = made_.size() - inside;
        for (std::size_t i = kept; i < made_.size(); ++i) {
            constants.inside.push_back(std::move(made_[i]));
        }
        made_.resize(kept);
        stages_.resize(kept);
        made_.push_back({&kind, std::move(constants)});
        stages_.push_back({kind.core, kind.fill(made_.back().constants)});
    }

    std::deque<hyst::kinds::Constants> controls_;
    std::deque<hyst::kinds::Inside> made_;
    std::vector<hyst_stage> stages_;
    std::vector<float> state_;
    hyst_tracking_controller controller_{};
    hyst_guard guard_{};
    bool has_two_inputs_ = false;
    bool is_limited_ = false, is_repetitive_ = false;
    hyst_repetitive_memory memory_{};
    int changed_ = 0;
    hyst_limited_tracking limited_{};
    hyst_limited_guard limited_guard_{};
    std::vector<float> before_;
    float v_ = 0.0f, excess_ = 0.0f;
    bool is_bank_ = false, is_model_ = false;
    hyst_bank_limits ends_{};
    std::unique_ptr<hyst::LimitedDrive> drive_;
};

// Scale and offset; the constants are those that the engine's estimator in double tells.
class ScaleEstimator {
public:
    ScaleEstimator(const std::vector<double> &constants, const std::vector<bool> &held,
                   const std::vector<double> &start)
        : state_(start.begin(), start.end()) {
        if (constants.size() != 5 || held.size() != 2 || state_.size() != HYST_SCALE_LENGTH) {
            throw std::invalid_argument("constants, held or start have the wrong length");
        }
        const auto of = [&](std::size_t place) { return static_cast<float>(constants[place]); };
        scale_ = {of(0), of(1), of(2), of(3), of(4), held[0], held[1]};
    }
    int step(double w, double y) {
        return hyst_scale_step(&scale_, state_.data(), static_cast<float>(w),
                               static_cast<float>(y));
    }
    std::vector<double> state() const { return {state_.begin(), state_.end()}; }

private:
    std::vector<float> state_;
    hyst_scale scale_{};
};

// A joint estimator; the constants are those that the engine's estimator in double tells.
class Estimator {
public:
    Estimator(const Tables &constants, const std::vector<double> &start)
        : state_(start.begin(), start.end()) {
        const auto of = [&](const std::string &name) { return keep(constants.at(name)); };
        const float *bounds = of("bounds"), *memory = of("memory");
        joint_ = {static_cast<std::size_t>(constants.at("plays").at(0)),
                  map(constants, "front"),
                  map(constants, "back"),
                  bounds[0],
                  bounds[1],
                  bounds[2],
                  memory[0],
                  memory[1],
                  memory[2],
                  memory[3],
                  memory[4],
                  of("limit")};
        search_ = {&joint_,          constants.at("cell_radius").size(),
                   of("cell_radius"), of("cell_start"),
                   of("cell_limit"),  *of("cell_noise")};
        if (hyst_search_places(&search_).length != state_.size()) {
            throw std::invalid_argument("start has the wrong length");
        }
    }
    Estimator(const Estimator &) = delete;
    Estimator &operator=(const Estimator &) = delete;

    int step(double u, double y) {
        return hyst_search_step(&search_, state_.data(), static_cast<float>(u),
                                static_cast<float>(y));
    }
    double command(double y_ref) const {
        return hyst_joint_command(&joint_, state_.data(), static_cast<float>(y_ref));
    }
    std::vector<double> state() const { return {state_.begin(), state_.end()}; }

private:
    const float *keep(const std::vector<double> &values) {
        home_.emplace_back(values.begin(), values.end());
        return home_.back().data();
    }
    hyst_joint_map map(const Tables &constants, const std::string &name) {
        const std::vector<double> &threshold = constants.at(name);
        const float *slopes = keep(constants.at(name + "_slopes"));
        std::size_t positive = 0;
        for (double each : threshold) positive += each > 0.0;
        return {threshold.size(), positive, keep(threshold), slopes[0], slopes[1]};
    }

    std::deque<std::vector<float>> home_;
    std::vector<float> state_;
    hyst_joint joint_{};
    hyst_search search_{};
};

}  // namespace

NB_MODULE(_single, module) {
    nb::class_<Stepper>(module, "Stepper")
        .def(nb::init<const std::vector<Description> &, const std::vector<double> &>(),
             nb::arg("stages"), nb::arg("start"))
        .def("__call__", &Stepper::step, nb::arg("u"))
        .def("__call__", &Stepper::step_controller, nb::arg("y_ref"), nb::arg("y"))
        .def_prop_ro("state", &Stepper::state)
        .def_prop_ro("fault", &Stepper::fault)
        .def_prop_ro("limited", &Stepper::limited)
        .def("clear_fault", &Stepper::clear_fault)
        .def("peek", &Stepper::peek, nb::arg("u"));
    hyst::single::bind_moving(module);
    nb::class_<ScaleEstimator>(module, "ScaleEstimator")
        .def(nb::init<const std::vector<double> &, const std::vector<bool> &,
                      const std::vector<double> &>(),
             nb::arg("constants"), nb::arg("held"), nb::arg("start"))
        .def("step", &ScaleEstimator::step, nb::arg("w"), nb::arg("y"))
        .def_prop_ro("state", &ScaleEstimator::state);
    nb::class_<Estimator>(module, "Estimator")
        .def(nb::init<const Tables &, const std::vector<double> &>(), nb::arg("constants"),
             nb::arg("start"))
        .def("step", &Estimator::step, nb::arg("u"), nb::arg("y"))
        .def("command", &Estimator::command, nb::arg("y_ref"))
        .def_prop_ro("state", &Estimator::state);
}
