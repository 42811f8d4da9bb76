// What Python sees of the engine. Arguments are checked in Python, by the operators; here only
// shapes that would write outside an array are refused.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>
#include <utility>

#include "chain.hpp"
#include "gram.hpp"
#include "jacobian.hpp"
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

void run(const hyst::Chain &chain, Matrix state, Batch u, Matrix y) {
    const std::size_t batch = u.shape(0), samples = u.shape(1), length = chain.state_length();
    require(y.shape(0) == batch && y.shape(1) == samples, "y must have the shape of u");
    require(state.shape(0) == batch && state.shape(1) == length, "state has the wrong shape");
    const nb::gil_scoped_release released;
    for (std::size_t b = 0; b < batch; ++b) {
        chain.run(state.data() + b * length, u.data() + b * samples, y.data() + b * samples,
                  samples);
    }
}

void jacobian(const hyst::Chain &chain, Vector state, Signal u, Matrix result) {
    require(state.shape(0) == chain.state_length(), "state has the wrong length");
    require(result.shape(0) == u.shape(0) && result.shape(1) == chain.parameter_count(),
            "the Jacobian has the wrong shape");
    const nb::gil_scoped_release released;
    hyst::jacobian(chain, state.data(), u.data(), u.shape(0), result.data());
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
    module.doc() = "Compiled engine of hyst: the C core on whole records, and derivatives.";
    nb::class_<hyst::Chain>(module, "Chain")
        .def(nb::init<>())
        .def("add_affine", &hyst::Chain::add_affine)
        .def("add_play", &hyst::Chain::add_play)
        .def("add_stop", &hyst::Chain::add_stop)
        .def("add_dead_zone", &hyst::Chain::add_dead_zone)
        .def("add_pi", &hyst::Chain::add_pi)
        .def("add_rate_dependent_pi",
             [](hyst::Chain &chain, double p0, std::vector<double> p, std::vector<double> r,
                double beta, std::vector<double> powers, std::vector<double> slopes,
                std::vector<double> knees, double dt) {
                 const hyst::RateCurve curve{beta, std::move(powers), std::move(slopes),
                                             std::move(knees)};
                 chain.add_rate_dependent_pi(p0, std::move(p), std::move(r), curve, dt);
             })
        .def("add_state_space", &hyst::Chain::add_state_space)
        .def("add_sections", &hyst::Chain::add_sections)
        .def_prop_ro("state_length", &hyst::Chain::state_length)
        .def_prop_ro("parameter_count", &hyst::Chain::parameter_count)
        .def("run", &run, nb::arg("state").noconvert(), nb::arg("u").noconvert(),
             nb::arg("y").noconvert())
        .def("jacobian", &jacobian, nb::arg("state").noconvert(), nb::arg("u").noconvert(),
             nb::arg("result").noconvert());
    module.def("play_gram", &gram, nb::arg("r"), nb::arg("z").noconvert(),
               nb::arg("u").noconvert(), nb::arg("y").noconvert(), nb::arg("edges"),
               nb::arg("result").noconvert());
    module.def("play_outputs", &outputs, nb::arg("r"), nb::arg("z").noconvert(),
               nb::arg("u").noconvert(), nb::arg("result").noconvert());
    module.def("run_with_thresholds", &run_with_thresholds, nb::arg("p0"), nb::arg("p"),
               nb::arg("r").noconvert(), nb::arg("z").noconvert(), nb::arg("u").noconvert(),
               nb::arg("y").noconvert());
    module.def("stepper", &stepper, nb::arg("chain"), nb::arg("state"), nb::arg("y_safe"));
    if (!hyst::register_stepper(module.ptr())) throw nb::python_error();
}
