// Stages whose constants follow a second signal, one sample at a time in single precision.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "../limited_moving.hpp"
#include "../moving.hpp"
#include "single_stages.hpp"

namespace hyst::single {

// What each knot has of stages whose constants follow a second signal.
using Knots = std::vector<std::vector<Description>>;

inline std::vector<Moving::Stages> stages_of(const Knots &knots) {
    std::vector<Moving::Stages> made(knots.size());
    for (std::size_t k = 0; k < knots.size(); ++k) {
        for (const Description &each : knots[k]) {
            made[k].emplace_back(&kinds::known_kind(std::get<0>(each)), rounded(each));
        }
    }
    return made;
}

class MovingStepper {
public:
    MovingStepper(const std::vector<double> &at, const Knots &knots,
                  const std::vector<double> &start)
        : moving_({at.begin(), at.end()}, stages_of(knots)), state_(start.begin(), start.end()) {
        if (moving_.state_length() != state_.size()) {
            throw std::invalid_argument("start has the wrong length");
        }
    }

    double step(double u, double s) {
        return moving_.step(state_.data(), &guard_, &outside_, static_cast<float>(u),
                            static_cast<float>(s));
    }

private:
    Moving moving_;
    std::vector<float> state_;
    hyst_guard guard_{};
    int outside_ = 0;
};

// The same with a drive that is limited, as LimitedMovingStepper of the engine has it.
class LimitedMovingStepper {
public:
    LimitedMovingStepper(const std::vector<double> &at, const Knots &knots, const Knots &forwards,
                         bool is_inverse, double low, double high, double change,
                         const std::vector<double> &start)
        : moving_({at.begin(), at.end()}, stages_of(knots), stages_of(forwards), is_inverse,
                  {static_cast<float>(low), static_cast<float>(high), static_cast<float>(change)}),
          state_(start.begin(), start.end()) {
        if (moving_.state_length() != state_.size()) {
            throw std::invalid_argument("start has the wrong length");
        }
        moving_.begin(state_.data());
    }
    double step(double x, double s) {
        return moving_.step(state_.data(), static_cast<float>(x), static_cast<float>(s));
    }
    bool lead(double drive, double s) {
        return moving_.lead(state_.data(), static_cast<float>(drive), static_cast<float>(s));
    }
    std::vector<double> state() const { return {state_.begin(), state_.end()}; }
    bool fault() const { return moving_.guard.guard.fault != 0; }
    bool limited() const { return moving_.guard.limited != 0; }
    bool outside() const { return moving_.outside != 0; }
    void clear_fault() { moving_.clear_fault(); }

private:
    LimitedMoving moving_;
    std::vector<float> state_;
};

inline void bind_moving(nanobind::module_ &module) {
    namespace nb = nanobind;
    nb::class_<MovingStepper>(module, "MovingStepper")
        .def(nb::init<const std::vector<double> &, const Knots &, const std::vector<double> &>(),
             nb::arg("at"), nb::arg("knots"), nb::arg("start"))
        .def("__call__", &MovingStepper::step, nb::arg("u"), nb::arg("s"));
    nb::class_<LimitedMovingStepper>(module, "LimitedMovingStepper")
        .def(nb::init<const std::vector<double> &, const Knots &, const Knots &, bool, double,
                      double, double, const std::vector<double> &>(),
             nb::arg("at"), nb::arg("knots"), nb::arg("forward"), nb::arg("is_inverse"),
             nb::arg("low"), nb::arg("high"), nb::arg("change"), nb::arg("start"))
        .def("__call__", &LimitedMovingStepper::step, nb::arg("x"), nb::arg("s"))
        .def("lead", &LimitedMovingStepper::lead, nb::arg("drive"), nb::arg("s"))
        .def_prop_ro("state", &LimitedMovingStepper::state)
        .def_prop_ro("fault", &LimitedMovingStepper::fault)
        .def_prop_ro("limited", &LimitedMovingStepper::limited)
        .def_prop_ro("outside", &LimitedMovingStepper::outside)
        .def("clear_fault", &LimitedMovingStepper::clear_fault);
}

}  // namespace hyst::single
