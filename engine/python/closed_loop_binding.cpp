// Arguments are checked in Python; what is checked here is only that nothing is written outside an
// array.
#include "closed_loop_binding.hpp"

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "loop_signals.hpp"

namespace nb = nanobind;

namespace hyst {
namespace {

using Vector = nb::ndarray<double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Signal = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Matrix = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

void require(bool holds, const char *message) {
    if (!holds) throw std::invalid_argument(message);
}

// The core's controller with the memory its constants live in. The chains are kept alive by Python.
class Controller {
public:
    Controller(std::vector<double> a, std::vector<double> b, std::vector<double> c, double d_ref,
               double d, const Chain &inverse)
        : a_(std::move(a)), b_(std::move(b)), c_(std::move(c)), inverse_(&inverse) {
        const std::size_t n = c_.size();
        require(n <= HYST_LARGEST_ORDER && a_.size() == n * n && b_.size() == 2 * n,
                "the matrices of the controller do not fit each other");
        view_ = {n, a_.data(), b_.data(), c_.data(), {d_ref, d}, inverse.view()};
    }
    Controller(const Controller &) = delete;
    Controller &operator=(const Controller &) = delete;

    // change: 0 for drives that may jump.
    void limit(std::vector<double> w, const Chain &forward, double low, double high,
               double change) {
        require(w.size() == c_.size() && low <= high && change >= 0.0, "the limits cannot be used");
        w_ = std::move(w);
        limited_view_ = {view_, w_.data(), {view_.inverse, forward.view(), {low, high, change}}};
        is_limited_ = true;
    }

    bool is_limited() const { return is_limited_; }
    const hyst_tracking_controller &view() const { return view_; }
    const Chain &inverse() const { return *inverse_; }
    const hyst_limited_tracking &limited_view() const { return limited_view_; }
    std::size_t state_length() const {
        return is_limited_ ? hyst_limited_tracking_state_length(&limited_view_)
                           : hyst_tracking_controller_state_length(&view_);
    }

    // Index of the first sample that could not be answered, or -1.
    std::ptrdiff_t run(Vector state, Signal y_ref, Signal y, Vector u) const;
    // The same for v, the one that belongs to the drive, and the estimate e x + f [y_ref; y] and g times
    // v minus the v wanted.
    std::ptrdiff_t tell(Vector state, Signal y_ref, Signal y, const std::vector<double> &e,
                        double f_ref, double f, double g, Vector v, Vector d_hat) const;

private:
    std::vector<double> a_, b_, c_, w_;
    const Chain *inverse_;
    hyst_tracking_controller view_;
    hyst_limited_tracking limited_view_{};
    bool is_limited_ = false;
};

// One sample after the other, with or without limits.
class Steps {
public:
    Steps(const Controller &controller, double *state)
        : controller_(controller), state_(state) {
        if (!controller.is_limited()) return;
        before_.resize(controller.state_length());
        guard_.guard.y_last = state_[controller.state_length() - 1];
    }
    double step(double y_ref, double y) {
        if (!controller_.is_limited()) {
            return hyst_guarded_tracking_step(&controller_.view(), state_, &guard_.guard, y_ref, y);
        }
        return hyst_limited_tracking_step(&controller_.limited_view(), state_, before_.data(),
                                          &guard_, y_ref, y, &v_, &excess_);
    }
    bool fault() const { return guard_.guard.fault != 0; }
    bool limited() const { return guard_.limited != 0; }
    void clear_fault() { guard_.guard.fault = 0, guard_.limited = 0; }
    // Whether a sample, before which the faults were cleared, was answered: where no drive belongs to
    // v, a limited block holds the last one and goes on, as it does on a target.
    bool answered() const { return !fault() || limited(); }
    double v() const { return v_; }
    double excess() const { return excess_; }

private:
    const Controller &controller_;
    double *state_;
    std::vector<double> before_;
    hyst_limited_guard guard_ = {{0.0, 0}, 0};
    double v_ = 0.0, excess_ = 0.0;
};

std::ptrdiff_t Controller::run(Vector state, Signal y_ref, Signal y, Vector u) const {
    const std::size_t samples = u.shape(0);
    require(state.shape(0) == state_length(), "state has the wrong length");
    require(y_ref.shape(0) == samples && y.shape(0) == samples, "lengths differ");
    const nb::gil_scoped_release released;
    Steps steps(*this, state.data());
    for (std::size_t k = 0; k < samples; ++k) {
        steps.clear_fault();
        u(k) = steps.step(y_ref(k), y(k));
        if (!steps.answered()) return static_cast<std::ptrdiff_t>(k);
    }
    return -1;
}

std::ptrdiff_t Controller::tell(Vector state, Signal y_ref, Signal y, const std::vector<double> &e,
                                double f_ref, double f, double g, Vector v, Vector d_hat) const {
    const std::size_t samples = v.shape(0), n = c_.size();
    require(is_limited_ && state.shape(0) == state_length() && e.size() == n,
            "state has the wrong length");
    require(y_ref.shape(0) == samples && y.shape(0) == samples && d_hat.shape(0) == samples,
            "lengths differ");
    const nb::gil_scoped_release released;
    Steps steps(*this, state.data());
    for (std::size_t k = 0; k < samples; ++k) {
        // In the order of the core's linear part, so that without limits the bits are its own.
        double estimate = f_ref * y_ref(k) + f * y(k);
        for (std::size_t j = 0; j < n; ++j) estimate += e[j] * state(j);
        steps.clear_fault();
        steps.step(y_ref(k), y(k));
        if (steps.excess() != 0.0) estimate += g * steps.excess();
        v(k) = steps.v(), d_hat(k) = estimate;
        if (!steps.answered()) return static_cast<std::ptrdiff_t>(k);
    }
    return -1;
}

class ControllerStepper {
public:
    ControllerStepper(const Controller &controller, nb::object owner)
        : owner_(std::move(owner)), state_(nb::cast<Vector>(owner_, /* convert = */ false)),
          steps_(controller, checked(state_, controller)) {}
    double step(double y_ref, double y) { return steps_.step(y_ref, y); }
    nb::object state() const { return owner_; }
    bool fault() const { return steps_.fault(); }
    bool limited() const { return steps_.limited(); }
    void clear_fault() { steps_.clear_fault(); }

private:
    static double *checked(const Vector &state, const Controller &controller) {
        require(state.shape(0) == controller.state_length(), "state has the wrong length");
        return state.data();
    }
    nb::object owner_;  // the array itself, so that Python gets back what it gave
    Vector state_;
    Steps steps_;
};

std::vector<double> copied(const Signal &state, std::size_t length) {
    require(state.shape(0) == length, "state has the wrong length");
    return {state.data(), state.data() + length};
}

nb::tuple told(const LoopResult &result) {
    static const char *const ends[] = {"done", "diverged", "no-solution"};
    return nb::make_tuple(ends[static_cast<int>(result.end)], result.samples,
                          result.held);
}

nb::tuple continuous(Matrix step, bool delayed, const Chain &inverse, const Chain &hysteresis,
                     Signal inverse_state, Signal hysteresis_state, LoopRecord r, LoopRecord noise,
                     LoopRecord before, LoopRecord behind, LoopOutputs out, double limit) {
    const LoopSignals signals = LoopRecords{r, noise, before, behind}.with(out);
    require(step.shape(0) == step.shape(1) && step.shape(0) >= 3, "step has the wrong shape");
    std::vector<double> first = copied(inverse_state, inverse.state_length());
    std::vector<double> second = copied(hysteresis_state, hysteresis.state_length());
    LoopResult result;
    {
        const nb::gil_scoped_release released;
        result = run_continuous_loop(step.shape(0) - 3, step.data(), delayed, inverse, hysteresis,
                                     first, second, signals, limit);
    }
    return told(result);
}

// e: empty where the controller does not tell its estimate.
nb::tuple sampled(Matrix step, const Controller &controller, const std::vector<double> &e,
                  double f_ref, double f, const Chain &hysteresis, Signal controller_state,
                  Signal hysteresis_state, LoopRecord r, LoopRecord noise, LoopRecord before,
                  LoopRecord behind, LoopOutputs out, double limit) {
    const LoopSignals signals = LoopRecords{r, noise, before, behind}.with(out);
    const bool tells = !e.empty();
    require(!tells || e.size() == controller.view().order, "the estimate does not fit");
    require(step.shape(0) == step.shape(1) && step.shape(0) >= 1, "step has the wrong shape");
    std::vector<double> first = copied(controller_state, controller.state_length());
    std::vector<double> second = copied(hysteresis_state, hysteresis.state_length());
    LoopResult result;
    {
        const nb::gil_scoped_release released;
        const std::size_t n = step.shape(0) - 1;
        result = controller.is_limited()
                     ? run_limited_loop(n, step.data(), controller.limited_view(), hysteresis,
                                        first, second, signals, limit)
                     : run_sampled_loop(n, step.data(), controller.view(), controller.inverse(),
                                        {tells ? e.data() : nullptr, {f_ref, f}}, hysteresis,
                                        first, second, signals, limit);
    }
    return told(result);
}

}  // namespace

void bind_closed_loop(nb::module_ &module) {
    nb::class_<Controller>(module, "TrackingController")
        .def(nb::init<std::vector<double>, std::vector<double>, std::vector<double>, double, double,
                      const Chain &>(),
             nb::arg("a"), nb::arg("b"), nb::arg("c"), nb::arg("d_ref"), nb::arg("d"),
             nb::arg("inverse"), nb::keep_alive<1, 7>())
        .def("limit", &Controller::limit, nb::arg("w"), nb::arg("forward"), nb::arg("low"),
             nb::arg("high"), nb::arg("change"), nb::keep_alive<1, 3>())
        .def_prop_ro("state_length", &Controller::state_length)
        .def("run", &Controller::run, nb::arg("state").noconvert(), nb::arg("y_ref").noconvert(),
             nb::arg("y").noconvert(), nb::arg("u").noconvert())
        .def("tell", &Controller::tell, nb::arg("state").noconvert(), nb::arg("y_ref").noconvert(),
             nb::arg("y").noconvert(), nb::arg("e"), nb::arg("f_ref"), nb::arg("f"), nb::arg("g"),
             nb::arg("v").noconvert(), nb::arg("d_hat").noconvert());
    nb::class_<ControllerStepper>(module, "TrackingStepper")
        .def(nb::init<const Controller &, nb::object>(), nb::arg("controller"), nb::arg("state"),
             nb::keep_alive<1, 2>())
        .def_prop_ro("state", &ControllerStepper::state)
        .def_prop_ro("fault", &ControllerStepper::fault)
        .def_prop_ro("limited", &ControllerStepper::limited)
        .def("clear_fault", &ControllerStepper::clear_fault)
        .def("__call__", &ControllerStepper::step, nb::arg("y_ref"), nb::arg("y"));
    module.def("run_continuous_loop", &continuous, nb::arg("step").noconvert(), nb::arg("delayed"),
               nb::arg("inverse"), nb::arg("hysteresis"), nb::arg("inverse_state").noconvert(),
               nb::arg("hysteresis_state").noconvert(), nb::arg("r").noconvert(), nb::arg("noise").noconvert(),
               nb::arg("before").noconvert(), nb::arg("behind").noconvert(),
               nb::arg("outputs").noconvert(), nb::arg("limit"));
    module.def("run_sampled_loop", &sampled, nb::arg("step").noconvert(), nb::arg("controller"),
               nb::arg("e"), nb::arg("f_ref"), nb::arg("f"), nb::arg("hysteresis"), nb::arg("controller_state").noconvert(),
               nb::arg("hysteresis_state").noconvert(), nb::arg("r").noconvert(), nb::arg("noise").noconvert(),
               nb::arg("before").noconvert(), nb::arg("behind").noconvert(),
               nb::arg("outputs").noconvert(), nb::arg("limit"));
}

}  // namespace hyst
