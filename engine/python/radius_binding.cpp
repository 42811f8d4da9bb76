// Radii of the core, one sample or one record at a time; the state is an array of Python.
#include "online_binding.hpp"

#include <nanobind/ndarray.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "hyst/hyst.h"

#include <cstddef>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace nb = nanobind;

namespace hyst {
namespace {

using State = nb::ndarray<double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Rows = nb::ndarray<double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Signal = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

void require(bool holds, const char *message) {
    if (!holds) throw std::invalid_argument(message);
}

class Radius {
public:
    Radius(double p0, std::vector<double> p, std::vector<double> gain, std::vector<double> limit)
        : p_(std::move(p)), gain_(std::move(gain)), limit_(std::move(limit)) {
        config_ = {};
        config_.plays = p_.size();
        config_.p0 = p0;
        config_.p = p_.data();
        config_.gain = gain_.data();
        config_.limit = limit_.data();
        places_ = hyst_radius_places(&config_);
        require(gain_.size() == p_.size() && limit_.size() == p_.size(),
                "gain and limit must have one entry for each play");
    }
    Radius(const Radius &) = delete;
    Radius &operator=(const Radius &) = delete;

    void set_method(bool least_squares, double growth, double most_radius) {
        config_.least_squares = least_squares;
        config_.growth = growth;
        config_.most_radius = most_radius;
    }
    void set_slope_filter(double memory, double dead_time, double dead_band, double tolerance) {
        config_.memory = memory;
        config_.dead_time = dead_time;
        config_.dead_band = dead_band;
        config_.tolerance = tolerance;
    }
    std::map<std::string, std::size_t> places() const {
        return {{"r", places_.r},       {"home", places_.home}, {"side", places_.side},
                {"age", places_.age},   {"d", places_.d},       {"u", places_.u},
                {"length", places_.length}};
    }
    void start(State state, Signal z0) const {
        require(z0.shape(0) == p_.size(), "z0 must have one entry for each play");
        hyst_radius_start(&config_, checked(state), z0.data());
    }
    bool step(State state, double u, double y) const {
        return hyst_radius_step(&config_, checked(state), u, y) != 0;
    }
    bool step_told(State state, double u, double y, bool is_slope, double told) const {
        return hyst_radius_step_told(&config_, checked(state), u, y, is_slope, told) != 0;
    }
    void follow(State state, Signal u) const {
        double *values = checked(state);
        for (std::size_t k = 0; k < u.shape(0); ++k) hyst_radius_follow(&config_, values, u.data()[k]);
    }
    // told: empty, or a slope or regime for each sample.
    void run(State state, Signal u, Signal y, std::size_t every, Rows r, State error,
             bool is_slope, Signal told) const {
        double *values = checked(state);
        const std::size_t given = told.shape(0);
        require(given == 0 || given == u.shape(0), "told and u differ in length");
        const std::size_t samples = u.shape(0);
        require(y.shape(0) == samples && error.shape(0) == samples, "u, y and error differ in length");
        require(every > 0 && r.shape(0) == samples / every && r.shape(1) == p_.size(),
                "r has the wrong shape");
        nb::gil_scoped_release unlocked;
        for (std::size_t k = 0; k < samples; ++k) {
            const double u_k = u.data()[k], y_k = y.data()[k];
            const int used =
                given > 0 ? hyst_radius_step_told(&config_, values, u_k, y_k, is_slope, told.data()[k])
                          : hyst_radius_step(&config_, values, u_k, y_k);
            error.data()[k] = used ? values[HYST_RADIUS_ERROR] : 0.0;
            for (std::size_t i = 0; i < p_.size() && (k + 1) % every == 0; ++i) {
                r.data()[k / every * p_.size() + i] = values[places_.r + i];
            }
        }
    }

private:
    double *checked(const State &state) const {
        require(state.shape(0) == places_.length, "state has the wrong length");
        return state.data();
    }

    std::vector<double> p_, gain_, limit_;
    hyst_radius config_;
    hyst_radius_layout places_;
};

void project_radii(State r, double most) {
    hyst_isotonic(r.shape(0), r.data(), 0.0, most);
}

}  // namespace

void bind_radius_estimation(nb::module_ &module) {
    nb::class_<Radius>(module, "RadiusEstimation")
        .def(nb::init<double, std::vector<double>, std::vector<double>, std::vector<double>>())
        .def("set_method", &Radius::set_method)
        .def("set_slope_filter", &Radius::set_slope_filter)
        .def("places", &Radius::places)
        .def("start", &Radius::start, nb::arg("state").noconvert(), nb::arg("z0").noconvert())
        .def("step", &Radius::step, nb::arg("state").noconvert(), nb::arg("u"), nb::arg("y"))
        .def("step_told", &Radius::step_told, nb::arg("state").noconvert(), nb::arg("u"),
             nb::arg("y"), nb::arg("is_slope"), nb::arg("told"))
        .def("follow", &Radius::follow, nb::arg("state").noconvert(), nb::arg("u").noconvert())
        .def("run", &Radius::run, nb::arg("state").noconvert(), nb::arg("u").noconvert(),
             nb::arg("y").noconvert(), nb::arg("every"), nb::arg("r").noconvert(),
             nb::arg("error").noconvert(), nb::arg("is_slope"), nb::arg("told").noconvert());
    module.def("project_radii", &project_radii, nb::arg("r").noconvert(), nb::arg("most"));
}

}  // namespace hyst
