// Arguments are checked in Python; what is checked here is only that nothing is written outside an
// array.
#include "repetitive_binding.hpp"

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

void demand(bool holds, const char *message) {
    if (!holds) throw std::invalid_argument(message);
}

// The core's constants with the memory they live in. The chains are kept alive by Python.
class Repetitive {
public:
    Repetitive(std::size_t period, std::size_t lead, std::size_t wait, std::vector<double> smooth,
               std::vector<double> learn, double tolerance, const Chain &inverse)
        : smooth_(std::move(smooth)), learn_(std::move(learn)), inverse_(inverse.view()) {
        demand(!smooth_.empty() && lead < learn_.size() && smooth_.size() - 1 + lead < period,
               "the filters do not fit the period");
        // A tolerance below 0 is none: references are not compared.
        memory_ = {period, smooth_.size() - 1, lead, learn_.size(), wait, tolerance >= 0.0,
                   tolerance, smooth_.data(), learn_.data()};
    }
    Repetitive(const Repetitive &) = delete;
    Repetitive &operator=(const Repetitive &) = delete;

    // change: 0 for drives that may jump.
    void limit(const Chain &forward, double low, double high, double change) {
        demand(low <= high && change >= 0.0, "the limits cannot be used");
        limited_ = {inverse_, forward.view(), {low, high, change}};
        is_limited_ = true;
    }

    const hyst_repetitive_memory &memory() const { return memory_; }
    const hyst_chain &inverse() const { return inverse_; }
    const hyst_limited_inverse *limited() const { return is_limited_ ? &limited_ : nullptr; }
    std::size_t memory_length() const { return hyst_repetitive_memory_length(&memory_); }
    std::size_t state_length() const {
        return memory_length() + (is_limited_ ? hyst_limited_inverse_state_length(&limited_)
                                              : hyst_chain_state_length(&inverse_));
    }

    // Index of the first sample that could not be answered, or -1; v: that which belongs to the drive.
    std::ptrdiff_t run(Vector state, Signal y_ref, Signal y, Vector u, Vector v) const;

private:
    std::vector<double> smooth_, learn_;
    hyst_chain inverse_;
    hyst_repetitive_memory memory_;
    hyst_limited_inverse limited_{};
    bool is_limited_ = false;
};

// One sample after the other, with or without limits.
class Samples {
public:
    Samples(const Repetitive &block, double *state) : block_(block), state_(state) {
        if (block.limited() == nullptr) return;
        before_.resize(block.state_length());
        guard_.guard.y_last = state_[block.state_length() - 1];
    }
    double step(double y_ref, double y) {
        if (block_.limited() == nullptr) {
            return hyst_repetitive_step(&block_.memory(), &block_.inverse(), state_, &guard_.guard,
                                        y_ref, y, &v_, &changed_);
        }
        return hyst_limited_repetitive_step(&block_.memory(), block_.limited(), state_,
                                            before_.data(), &guard_, y_ref, y, &v_, &changed_);
    }
    void forget() { hyst_repetitive_forget(&block_.memory(), state_); }
    bool fault() const { return guard_.guard.fault != 0; }
    bool limited() const { return guard_.limited != 0; }
    bool changed() const { return changed_ != 0; }
    void clear_fault() { guard_.guard.fault = 0, guard_.limited = 0, changed_ = 0; }
    // Where no drive belongs to v, a limited block holds the last one and goes on, as on a target.
    bool answered() const { return !fault() || limited(); }
    double v() const { return v_; }

private:
    const Repetitive &block_;
    double *state_;
    std::vector<double> before_;
    hyst_limited_guard guard_ = {{0.0, 0}, 0};
    double v_ = 0.0;
    int changed_ = 0;
};

std::ptrdiff_t Repetitive::run(Vector state, Signal y_ref, Signal y, Vector u, Vector v) const {
    const std::size_t samples = u.shape(0);
    demand(state.shape(0) == state_length(), "state has the wrong length");
    demand(y_ref.shape(0) == samples && y.shape(0) == samples && v.shape(0) == samples,
           "lengths differ");
    const nb::gil_scoped_release released;
    Samples steps(*this, state.data());
    for (std::size_t k = 0; k < samples; ++k) {
        steps.clear_fault();
        u(k) = steps.step(y_ref(k), y(k));
        v(k) = steps.v();
        if (!steps.answered()) return static_cast<std::ptrdiff_t>(k);
    }
    return -1;
}

class RepetitiveSteps {
public:
    RepetitiveSteps(const Repetitive &block, nb::object owner)
        : owner_(std::move(owner)), state_(nb::cast<Vector>(owner_, /* convert = */ false)),
          steps_(block, checked(state_, block)) {}
    double step(double y_ref, double y) { return steps_.step(y_ref, y); }
    void reset() { steps_.forget(); }
    nb::object state() const { return owner_; }
    bool fault() const { return steps_.fault(); }
    bool limited() const { return steps_.limited(); }
    bool changed() const { return steps_.changed(); }
    void clear_fault() { steps_.clear_fault(); }

private:
    static double *checked(const Vector &state, const Repetitive &block) {
        demand(state.shape(0) == block.state_length(), "state has the wrong length");
        return state.data();
    }
    nb::object owner_;  // the array itself, so that Python gets back what it gave
    Vector state_;
    Samples steps_;
};

nb::tuple loop(Matrix step, const Repetitive &block, const Chain &hysteresis,
               Signal controller_state, Signal hysteresis_state, LoopRecord r, LoopRecord noise,
               LoopRecord before, LoopRecord behind, LoopOutputs out, double limit) {
    const LoopSignals signals = LoopRecords{r, noise, before, behind}.with(out);
    demand(step.shape(0) == step.shape(1) && step.shape(0) >= 1, "step has the wrong shape");
    demand(controller_state.shape(0) == block.state_length() &&
               hysteresis_state.shape(0) == hysteresis.state_length(),
           "state has the wrong length");
    std::vector<double> first(controller_state.data(),
                              controller_state.data() + controller_state.shape(0));
    std::vector<double> second(hysteresis_state.data(),
                               hysteresis_state.data() + hysteresis_state.shape(0));
    LoopResult result;
    {
        const nb::gil_scoped_release released;
        result = run_repetitive_loop(step.shape(0) - 1, step.data(), block.memory(), block.inverse(),
                                     block.limited(), hysteresis, first, second, signals, limit);
    }
    return nb::make_tuple(result.end == LoopEnd::done ? "done" : "diverged", result.samples,
                          result.held);
}

}  // namespace

void bind_repetitive(nb::module_ &module) {
    nb::class_<Repetitive>(module, "RepetitiveController")
        .def(nb::init<std::size_t, std::size_t, std::size_t, std::vector<double>,
                      std::vector<double>, double, const Chain &>(),
             nb::arg("period"), nb::arg("lead"), nb::arg("wait"), nb::arg("smooth"),
             nb::arg("learn"), nb::arg("tolerance"), nb::arg("inverse"), nb::keep_alive<1, 8>())
        .def("limit", &Repetitive::limit, nb::arg("forward"), nb::arg("low"), nb::arg("high"),
             nb::arg("change"), nb::keep_alive<1, 2>())
        .def_prop_ro("memory_length", &Repetitive::memory_length)
        .def_prop_ro("state_length", &Repetitive::state_length)
        .def("run", &Repetitive::run, nb::arg("state").noconvert(), nb::arg("y_ref").noconvert(),
             nb::arg("y").noconvert(), nb::arg("u").noconvert(), nb::arg("v").noconvert());
    nb::class_<RepetitiveSteps>(module, "RepetitiveStepper")
        .def(nb::init<const Repetitive &, nb::object>(), nb::arg("controller"), nb::arg("state"),
             nb::keep_alive<1, 2>())
        .def_prop_ro("state", &RepetitiveSteps::state)
        .def_prop_ro("fault", &RepetitiveSteps::fault)
        .def_prop_ro("limited", &RepetitiveSteps::limited)
        .def_prop_ro("changed", &RepetitiveSteps::changed)
        .def("clear_fault", &RepetitiveSteps::clear_fault)
        .def("reset", &RepetitiveSteps::reset)
        .def("__call__", &RepetitiveSteps::step, nb::arg("y_ref"), nb::arg("y"));
    module.def("run_repetitive_loop", &loop, nb::arg("step").noconvert(), nb::arg("controller"),
               nb::arg("hysteresis"), nb::arg("controller_state").noconvert(),
               nb::arg("hysteresis_state").noconvert(), nb::arg("r").noconvert(), nb::arg("noise").noconvert(),
               nb::arg("before").noconvert(), nb::arg("behind").noconvert(),
               nb::arg("outputs").noconvert(), nb::arg("limit"));
}

}  // namespace hyst
