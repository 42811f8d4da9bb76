#include "moving_binding.hpp"

#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../limited_moving.hpp"
#include "../moving.hpp"
#include "chain_binding.hpp"

namespace nb = nanobind;

namespace hyst {
namespace {

using Vector = nb::ndarray<double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Signal = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

Moving::Stages derived(nb::handle stages) {
    Moving::Stages made;
    for (nb::handle stage : stages) {
        const kinds::Given given = as_given(stage);
        const kinds::Kind &kind = kinds::known_kind(given.kind);
        kinds::Constants constants;
        kind.derive(given, constants);
        made.emplace_back(&kind, std::move(constants));
    }
    return made;
}

std::vector<Moving::Stages> at_knots(nb::iterable knots) {
    std::vector<Moving::Stages> made;
    for (nb::handle stages : knots) made.push_back(derived(stages));
    return made;
}

// The constants are its own: a record and a stepper never share them. The interpreter's lock is kept,
// since a run moves them.
std::pair<std::ptrdiff_t, std::size_t> run(Moving &moving, Vector state, Signal u, Signal s, Vector y) {
    if (state.shape(0) != moving.state_length() || s.shape(0) != u.shape(0) ||
        y.shape(0) != u.shape(0)) {
        throw std::invalid_argument("arrays do not fit each other");
    }
    std::size_t held = 0;
    const std::size_t bad =
        moving.run(state.data(), u.data(), s.data(), y.data(), u.shape(0), held);
    return {bad < u.shape(0) ? static_cast<std::ptrdiff_t>(bad) : -1, held};
}

struct MovingStepper {
    Moving moving;
    Vector state;
    hyst_guard guard{};
    int outside = 0;

    MovingStepper(const std::vector<double> &at, nb::iterable knots, Vector memory)
        : moving(at, at_knots(knots)), state(std::move(memory)) {
        if (state.shape(0) != moving.state_length()) {
            throw std::invalid_argument("the state has the wrong length");
        }
    }
    double step(double u, double s) {
        return moving.step(state.data(), &guard, &outside, u, s);
    }
    void clear_fault() {
        guard.fault = 0;
        outside = 0;
    }
};

// The same with a drive that is limited.
struct LimitedMovingStepper {
    LimitedMoving moving;
    Vector state;

    LimitedMovingStepper(const std::vector<double> &at, nb::iterable knots, nb::iterable forwards,
                         bool is_inverse, double low, double high, double change, Vector memory)
        : moving(at, at_knots(knots), at_knots(forwards), is_inverse, {low, high, change}),
          state(std::move(memory)) {
        if (state.shape(0) != moving.state_length()) {
            throw std::invalid_argument("the state has the wrong length");
        }
        moving.begin(state.data());
    }
    double step(double x, double s) { return moving.step(state.data(), x, s); }
    bool lead(double drive, double s) { return moving.lead(state.data(), drive, s); }
    bool fault() const { return moving.guard.guard.fault != 0; }
    bool limited() const { return moving.guard.limited != 0; }
    bool outside() const { return moving.outside != 0; }
    void clear_fault() { moving.clear_fault(); }
};

// Index of the first sample that could not be answered, or -1; and how many were outside the schedule.
std::pair<std::ptrdiff_t, std::size_t> run_limited(LimitedMovingStepper &steps, Signal x, Signal s,
                                                   Vector y) {
    if (s.shape(0) != x.shape(0) || y.shape(0) != x.shape(0)) {
        throw std::invalid_argument("arrays do not fit each other");
    }
    std::size_t outside = 0;
    for (std::size_t k = 0; k < x.shape(0); ++k) {
        steps.clear_fault();
        y(k) = steps.step(x(k), s(k));
        outside += steps.outside() ? 1 : 0;
        if (steps.fault() && !steps.limited()) {
            return {static_cast<std::ptrdiff_t>(k), outside};
        }
    }
    return {-1, outside};
}

}  // namespace

void bind_moving(nb::module_ &module) {
    nb::class_<Moving>(module, "Moving")
        .def("__init__",
             [](Moving *made, const std::vector<double> &at, nb::iterable knots) {
                 new (made) Moving(at, at_knots(knots));
             },
             nb::arg("at"), nb::arg("knots"))
        .def_prop_ro("state_length", &Moving::state_length)
        .def("run", &run, nb::arg("state").noconvert(), nb::arg("u").noconvert(),
             nb::arg("s").noconvert(), nb::arg("y").noconvert());
    nb::class_<MovingStepper>(module, "MovingStepper")
        .def(nb::init<const std::vector<double> &, nb::iterable, Vector>(), nb::arg("at"),
             nb::arg("knots"), nb::arg("state").noconvert())
        .def("__call__", &MovingStepper::step, nb::arg("u"), nb::arg("s"))
        .def_prop_ro("state", [](MovingStepper &self) { return self.state; })
        .def_prop_ro("fault", [](const MovingStepper &self) { return self.guard.fault != 0; })
        .def_prop_ro("outside", [](const MovingStepper &self) { return self.outside != 0; })
        .def("clear_fault", &MovingStepper::clear_fault);
    nb::class_<LimitedMovingStepper>(module, "LimitedMovingStepper")
        .def(nb::init<const std::vector<double> &, nb::iterable, nb::iterable, bool, double,
                      double, double, Vector>(),
             nb::arg("at"), nb::arg("knots"), nb::arg("forward"), nb::arg("is_inverse"),
             nb::arg("low"), nb::arg("high"), nb::arg("change"), nb::arg("state").noconvert())
        .def("__call__", &LimitedMovingStepper::step, nb::arg("x"), nb::arg("s"))
        .def("run", &run_limited, nb::arg("x").noconvert(), nb::arg("s").noconvert(),
             nb::arg("y").noconvert())
        .def("lead", &LimitedMovingStepper::lead, nb::arg("drive"), nb::arg("s"))
        .def_prop_ro("state", [](LimitedMovingStepper &self) { return self.state; })
        .def_prop_ro("fault", &LimitedMovingStepper::fault)
        .def_prop_ro("limited", &LimitedMovingStepper::limited)
        .def_prop_ro("outside", &LimitedMovingStepper::outside)
        .def("clear_fault", &LimitedMovingStepper::clear_fault);
}

}  // namespace hyst
