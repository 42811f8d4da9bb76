// Arguments are checked in Python; what is checked here is only that nothing is written outside an
// array.
#include "limited_drive_binding.hpp"

#include <nanobind/ndarray.h>
#include <nanobind/stl/vector.h>

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

hyst_bank_end end_of(std::size_t moved, const std::vector<double> &numbers) {
    demand(numbers.size() == 4, "an end of a bank has four numbers");
    return {moved, numbers[0], numbers[1], numbers[2], numbers[3]};
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
             [](LimitedDrive *self, bool is_inverse, const Chain &chain, const Chain &forward,
                double low, double high, double change) {
                 demand(low <= high && change >= 0.0, "the limits cannot be used");
                 const auto way = is_inverse ? LimitedDrive::Way::forward : LimitedDrive::Way::model;
                 new (self) LimitedDrive(way, chain.view(), forward.view(), {low, high, change});
             },
             nb::arg("is_inverse"), nb::arg("chain"), nb::arg("forward"), nb::arg("low"),
             nb::arg("high"), nb::arg("change"), nb::keep_alive<1, 3>(), nb::keep_alive<1, 4>())
        .def("__init__",
             [](LimitedDrive *self, const Chain &chain, double low, double high,
                std::size_t moved_down, const std::vector<double> &down, std::size_t moved_up,
                const std::vector<double> &up) {
                 demand(low <= high, "the limits cannot be used");
                 const hyst_chain view = chain.view();
                 demand(moved_down < hyst_chain_state_length(&view) + 1 &&
                            moved_up < hyst_chain_state_length(&view) + 1,
                        "more plays move than there are");
                 new (self) LimitedDrive(
                     view, {low, high, end_of(moved_down, down), end_of(moved_up, up)});
             },
             nb::arg("chain"), nb::arg("low"), nb::arg("high"), nb::arg("moved_down"),
             nb::arg("down"), nb::arg("moved_up"), nb::arg("up"), nb::keep_alive<1, 2>())
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
