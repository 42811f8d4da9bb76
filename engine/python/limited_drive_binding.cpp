// Arguments are checked in Python; what is checked here is only that nothing is written outside an
// array.
#include "limited_drive_binding.hpp"

#include <nanobind/ndarray.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "../chain.hpp"
#include "../limited_drive.hpp"

namespace nb = nanobind;

namespace hyst {
namespace {

using Vector = nb::ndarray<double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Signal = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

void demand(bool holds, const char *message) {
    if (!holds) throw std::invalid_argument(message);
}

LimitedDrive made(std::size_t way, const Chain &chain, const Chain &forward, double low, double high,
                  double change, double v_low, double v_high) {
    demand(way <= 2, "there is no such way");
    demand(low <= high && change >= 0.0 && v_low <= v_high, "the limits cannot be used");
    return {static_cast<LimitedDrive::Way>(way), chain.view(), forward.view(),
            {{low, high, change}, v_low, v_high}};
}

// Index of the first sample that could not be answered, or -1; and how many were held. y may be x.
nb::tuple run(const LimitedDrive &drive, Vector state, Signal x, Vector y) {
    demand(state.shape(0) == drive.state_length(), "state has the wrong length");
    demand(x.shape(0) == y.shape(0), "lengths differ");
    std::vector<double> before(drive.state_length());
    hyst_limited_guard guard = {{drive.start(state.data()), 0}, 0};
    std::size_t held = 0;
    std::ptrdiff_t bad = -1;
    {
        const nb::gil_scoped_release released;
        for (std::size_t k = 0; k < x.shape(0) && bad < 0; ++k) {
            guard.guard.fault = guard.limited = 0;
            y(k) = drive.step(state.data(), before.data(), &guard, x(k));
            held += guard.limited != 0 ? 1 : 0;
            // Where no drive belongs to v, the last one is held, as on a target.
            if (guard.guard.fault != 0 && guard.limited == 0) bad = static_cast<std::ptrdiff_t>(k);
        }
    }
    return nb::make_tuple(bad, held);
}

// Takes the memory along drives; index of the first that it could not follow, or -1.
std::ptrdiff_t lead(const LimitedDrive &drive, Vector state, Signal u) {
    demand(state.shape(0) == drive.state_length(), "state has the wrong length");
    for (std::size_t k = 0; k < u.shape(0); ++k) {
        if (drive.lead(state.data(), u(k)) == 0) return static_cast<std::ptrdiff_t>(k);
    }
    return -1;
}

class LimitedStepper {
public:
    LimitedStepper(const LimitedDrive &drive, nb::object owner)
        : drive_(drive), owner_(std::move(owner)),
          state_(nb::cast<Vector>(owner_, /* convert = */ false)), before_(drive.state_length()) {
        demand(state_.shape(0) == drive.state_length(), "state has the wrong length");
        guard_.guard.y_last = drive.start(state_.data());
    }
    double step(double x) { return drive_.step(state_.data(), before_.data(), &guard_, x); }
    nb::object state() const { return owner_; }
    bool fault() const { return guard_.guard.fault != 0; }
    bool limited() const { return guard_.limited != 0; }
    void clear_fault() { guard_.guard.fault = guard_.limited = 0; }

private:
    const LimitedDrive &drive_;
    nb::object owner_;  // the array itself, so that Python gets back what it gave
    Vector state_;
    std::vector<double> before_;
    hyst_limited_guard guard_ = {{0.0, 0}, 0};
};

}  // namespace

void bind_limited_drive(nb::module_ &module) {
    nb::class_<LimitedDrive>(module, "LimitedDrive")
        .def("__init__",
             [](LimitedDrive *self, std::size_t way, const Chain &chain, const Chain &forward,
                double low, double high, double change, double v_low, double v_high) {
                 new (self) LimitedDrive(
                     made(way, chain, forward, low, high, change, v_low, v_high));
             },
             nb::arg("way"), nb::arg("chain"), nb::arg("forward"), nb::arg("low"),
             nb::arg("high"), nb::arg("change"), nb::arg("v_low"), nb::arg("v_high"),
             nb::keep_alive<1, 3>(), nb::keep_alive<1, 4>())
        .def_prop_ro("state_length", &LimitedDrive::state_length)
        .def("run", &run, nb::arg("state").noconvert(), nb::arg("x").noconvert(),
             nb::arg("y").noconvert())
        .def("lead", &lead, nb::arg("state").noconvert(), nb::arg("u").noconvert());
    nb::class_<LimitedStepper>(module, "LimitedStepper")
        .def(nb::init<const LimitedDrive &, nb::object>(), nb::arg("drive"), nb::arg("state"),
             nb::keep_alive<1, 2>())
        .def_prop_ro("state", &LimitedStepper::state)
        .def_prop_ro("fault", &LimitedStepper::fault)
        .def_prop_ro("limited", &LimitedStepper::limited)
        .def("clear_fault", &LimitedStepper::clear_fault)
        .def("__call__", &LimitedStepper::step, nb::arg("x"));
}

}  // namespace hyst
