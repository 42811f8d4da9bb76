// What Python sees of the engine. Arguments are checked in Python, by the operators; here only
// shapes that would write outside an array are refused.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "batch_binding.hpp"
#include "chain_binding.hpp"
#include "closed_loop_binding.hpp"
#include "../records/evaluation.hpp"
#include "../records/gradient.hpp"
#include "../records/gram.hpp"
#include "../records/in_place.hpp"
#include "../jacobian.hpp"
#include "limited_drive_binding.hpp"
#include "moving_binding.hpp"
#include "number_text_binding.hpp"
#include "online_binding.hpp"
#include "../reverse.hpp"
#include "rate_dependent_binding.hpp"
#include "repetitive_binding.hpp"
#include "../simd/kernels.hpp"
#include "stepper.hpp"

namespace nb = nanobind;

namespace {

using Vector = nb::ndarray<double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Matrix = nb::ndarray<double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Cube = nb::ndarray<double, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
using Signal = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Rows = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Batch = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

void require(bool holds, const char *message) {
    if (!holds) throw std::invalid_argument(message);
}

hyst::Engine engine_named(const std::string &name) {
    using hyst::Engine;
    for (Engine each : {Engine::automatic, Engine::loop, Engine::lanes, Engine::memory_curve}) {
        if (name == hyst::name_of(each)) return each;
    }
    throw std::invalid_argument("engine is '" + name +
                                "'; give auto, loop, lanes or memory-curve");
}

void require_record(const hyst::Chain &chain, const Matrix &state, const Batch &u, const Matrix &y) {
    require(y.shape(0) == u.shape(0) && y.shape(1) == u.shape(1), "y must have the shape of u");
    require(state.shape(0) == u.shape(0) && state.shape(1) == chain.state_length(),
            "state has the wrong shape");
}

void require_apart(const Batch &u, const Matrix &y) {
    const double *y_end = y.data() + y.size(), *u_end = u.data() + u.size();
    require(y_end <= u.data() || u_end <= y.data(), "y must not overlap u");
}

// Flat index of the first sample that is not finite or overflows, and nothing done; or -1. y may be u,
// which then is not what it was.
std::ptrdiff_t run(const hyst::Chain &chain, Matrix state, Batch u, Matrix y,
                   const std::string &engine, std::size_t threads) {
    require_record(chain, state, u, y);
    const hyst::Options options{engine_named(engine), threads};
    const std::size_t rows = u.shape(0), samples = u.shape(1);
    const bool in_place = u.data() == y.data();
    if (!in_place) require_apart(u, y);
    const nb::gil_scoped_release released;
    const std::size_t bad =
        in_place ? hyst::evaluate_in_place(chain, state.data(), y.data(), rows, samples, options)
                 : hyst::evaluate(chain, state.data(), u.data(), y.data(), rows, samples, options,
                                  nullptr);
    return bad < rows * samples ? static_cast<std::ptrdiff_t>(bad) : -1;
}

// Runs like `run`, gives what it gives, and tells for each stage: engine, reason, reversals per
// sample, and the expected nanoseconds per sample of loop, lanes and memory curve.
nb::tuple explain(const hyst::Chain &chain, Matrix state, Batch u, Matrix y,
                 const std::string &engine) {
    require_record(chain, state, u, y);
    require_apart(u, y);
    std::vector<hyst::Choice> choices;
    const std::size_t bad = hyst::evaluate(chain, state.data(), u.data(), y.data(), u.shape(0),
                                           u.shape(1), {engine_named(engine), 1}, &choices);
    nb::list told;
    for (const hyst::Choice &choice : choices) {
        told.append(nb::make_tuple(hyst::name_of(choice.engine), choice.reason,
                                   choice.rough.reversals, choice.loop, choice.lanes,
                                   choice.memory_curve));
    }
    return nb::make_tuple(bad < u.size() ? static_cast<std::ptrdiff_t>(bad) : -1, told);
}

double loss_gradient(const hyst::Chain &chain, Vector state, Signal u, Signal target,
                     Vector gradient, const std::string &engine, std::size_t threads) {
    require(state.shape(0) == chain.state_length(), "state has the wrong length");
    require(target.shape(0) == u.shape(0), "the target must have the length of u");
    require(gradient.shape(0) == chain.parameter_count(), "the gradient has the wrong length");
    const hyst::Options options{engine_named(engine), threads};
    const nb::gil_scoped_release released;
    return hyst::loss_gradient(chain, state.data(), u.data(), target.data(), u.shape(0), options,
                               gradient.data());
}

std::ptrdiff_t first_non_finite(Signal values) {
    const std::size_t bad = hyst::kernels().first_non_finite(values.data(), values.shape(0));
    return bad < values.shape(0) ? static_cast<std::ptrdiff_t>(bad) : -1;
}

std::vector<std::string> instruction_sets() {
    std::vector<std::string> names;
    for (auto each = hyst::available_kernels(); *each != nullptr; ++each) {
        names.emplace_back((*each)->name);
    }
    return names;
}

void use_instruction_set(const std::string &name) {
    if (!hyst::use_kernels(name.c_str())) {
        throw std::invalid_argument("instruction set '" + name + "' is not available here");
    }
}

void set_parameters(hyst::Chain &chain, Signal values) {
    require(values.shape(0) == chain.parameter_count(), "the parameters have the wrong length");
    chain.set_parameters(values.data());
}

hyst::Derivative derivative_named(const std::string &name) {
    require(name == "auto" || name == "kernel", "derivative is auto or kernel");
    return name == "auto" ? hyst::Derivative::automatic : hyst::Derivative::kernel;
}

void jacobian(const hyst::Chain &chain, Vector state, Signal u, Matrix result,
              const std::string &derivative) {
    require(state.shape(0) == chain.state_length(), "state has the wrong length");
    require(result.shape(0) == u.shape(0) && result.shape(1) == chain.parameter_count(),
            "the Jacobian has the wrong shape");
    const hyst::Derivative way = derivative_named(derivative);
    const nb::gil_scoped_release released;
    hyst::jacobian(chain, state.data(), u.data(), u.shape(0), way, result.data());
}

// Rows of records, each with its state; signal is in and out.
void reverse(const hyst::Chain &chain, Rows state, Batch u, Matrix signal, Matrix by_constants) {
    const std::size_t rows = u.shape(0), samples = u.shape(1), length = chain.state_length();
    require(state.shape(0) == rows && state.shape(1) == length, "state has the wrong shape");
    require(signal.shape(0) == rows && signal.shape(1) == samples, "signal must have the shape of u");
    require(by_constants.shape(0) == rows && by_constants.shape(1) == chain.parameter_count(),
            "the derivatives have the wrong shape");
    const nb::gil_scoped_release released;
    for (std::size_t i = 0; i < rows; ++i) {
        hyst::reverse(chain, state.data() + i * length, u.data() + i * samples, samples,
                      signal.data() + i * samples,
                      by_constants.data() + i * chain.parameter_count());
    }
}

void carry_jacobian(const hyst::Chain &chain, Vector state, Matrix memory, Vector signal,
                    Matrix result) {
    const std::size_t columns = chain.parameter_count();
    require(state.shape(0) == chain.state_length(), "state has the wrong length");
    require(memory.shape(0) == state.shape(0) && memory.shape(1) == columns,
            "the derivatives of the state have the wrong shape");
    require(result.shape(0) == signal.shape(0) && result.shape(1) == columns,
            "the Jacobian has the wrong shape");
    const nb::gil_scoped_release released;
    hyst::carry_jacobian(chain, state.data(), memory.data(), signal.data(), signal.shape(0),
                         result.data());
}

// Plays whose thresholds are given for every sample: row k of r.
void run_with_thresholds(double p0, const std::vector<double> &p, Rows r, Vector z, Signal u,
                         Vector y) {
    const std::size_t samples = u.shape(0), count = p.size();
    require(r.shape(0) == samples && r.shape(1) == count && z.shape(0) == count &&
                y.shape(0) == samples,
            "arrays do not fit each other");
    const nb::gil_scoped_release released;
    for (std::size_t k = 0; k < samples; ++k) {
        const hyst_pi pi = {count, p0, p.data(), r.data() + k * count};
        y(k) = hyst_pi_step(&pi, z.data(), u(k));
    }
}

void gram(const std::vector<double> &r, Vector z, Signal u, Signal y,
          const std::vector<std::size_t> &edges, Cube result) {
    const std::size_t width = r.size() + 3;
    require(z.shape(0) == r.size() && y.shape(0) == u.shape(0), "arrays do not fit each other");
    require(!edges.empty() && edges.back() <= u.shape(0), "the last edge is beyond the record");
    for (std::size_t b = 0; b + 1 < edges.size(); ++b) require(edges[b] <= edges[b + 1], "edges fall");
    require(result.shape(0) + 1 == edges.size() && result.shape(1) == width &&
                result.shape(2) == width,
            "the Gram matrices have the wrong shape");
    const nb::gil_scoped_release released;
    hyst::play_gram(r, z.data(), u.data(), y.data(), edges, result.data());
}

void outputs(const std::vector<double> &r, Vector z, Signal u, Matrix result) {
    require(z.shape(0) == r.size() && result.shape(0) == u.shape(0) &&
                result.shape(1) == r.size(),
            "arrays do not fit each other");
    const nb::gil_scoped_release released;
    hyst::play_outputs(r, z.data(), u.data(), u.shape(0), result.data());
}

nb::object stepper(nb::handle chain, nb::handle state, double y_safe) {
    PyObject *made = hyst::new_stepper(chain.ptr(), nb::cast<const hyst::Chain &>(chain),
                                       state.ptr(), y_safe);
    if (made == nullptr) throw nb::python_error();
    return nb::steal(made);
}

}  // namespace

NB_MODULE(_engine, module) {
    // Models that live until the interpreter ends are no leak worth a page of text to the user.
    nb::set_leak_warnings(false);
    module.doc() = "Compiled engine of hyst: the C core on whole records, and derivatives.";
    nb::class_<hyst::Chain> chain(module, "Chain");
    hyst::bind_stages(module, chain);
    chain.def("set_parameters", &set_parameters, nb::arg("values").noconvert())
        .def_prop_ro("state_length", &hyst::Chain::state_length)
        .def_prop_ro("parameter_count", &hyst::Chain::parameter_count)
        .def("run", &run, nb::arg("state").noconvert(), nb::arg("u").noconvert(),
             nb::arg("y").noconvert(), nb::arg("engine") = "auto", nb::arg("threads") = 1)
        .def("explain", &explain, nb::arg("state").noconvert(), nb::arg("u").noconvert(),
             nb::arg("y").noconvert(), nb::arg("engine") = "auto")
        .def("loss_gradient", &loss_gradient, nb::arg("state").noconvert(),
             nb::arg("u").noconvert(), nb::arg("target").noconvert(),
             nb::arg("gradient").noconvert(), nb::arg("engine") = "auto", nb::arg("threads") = 1)
        .def("jacobian", &jacobian, nb::arg("state").noconvert(), nb::arg("u").noconvert(),
             nb::arg("result").noconvert(), nb::arg("derivative") = "auto")
        .def("reverse", &reverse, nb::arg("state").noconvert(), nb::arg("u").noconvert(),
             nb::arg("signal").noconvert(), nb::arg("by_constants").noconvert())
        .def("carry_jacobian", &carry_jacobian, nb::arg("state").noconvert(),
             nb::arg("memory").noconvert(), nb::arg("signal").noconvert(),
             nb::arg("result").noconvert());
    module.def("play_gram", &gram, nb::arg("r"), nb::arg("z").noconvert(),
               nb::arg("u").noconvert(), nb::arg("y").noconvert(), nb::arg("edges"),
               nb::arg("result").noconvert());
    module.def("play_outputs", &outputs, nb::arg("r"), nb::arg("z").noconvert(),
               nb::arg("u").noconvert(), nb::arg("result").noconvert());
    module.def("run_with_thresholds", &run_with_thresholds, nb::arg("p0"), nb::arg("p"),
               nb::arg("r").noconvert(), nb::arg("z").noconvert(), nb::arg("u").noconvert(),
               nb::arg("y").noconvert());
    module.def("first_non_finite", &first_non_finite, nb::arg("values").noconvert());
    module.def("instruction_sets", &instruction_sets);
    module.def("instruction_set", [] { return hyst::kernels().name; });
    module.def("use_instruction_set", &use_instruction_set, nb::arg("name"));
    module.def("stepper", &stepper, nb::arg("chain"), nb::arg("state"), nb::arg("y_safe"));
    hyst::bind_batches(module);
    hyst::bind_closed_loop(module);
    hyst::bind_repetitive(module);
    hyst::bind_limited_drive(module);
    hyst::bind_moving(module);
    hyst::bind_number_text(module);
    hyst::bind_online_estimation(module);
    hyst::bind_rate_dependent_inversion(module);
    if (!hyst::register_stepper(module.ptr())) throw nb::python_error();
}
