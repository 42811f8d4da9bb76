// Scale and offset of the core, one sample or one record at a time; the state is an array of Python.
#include "online_binding.hpp"

#include <nanobind/ndarray.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "hyst/hyst.h"

#include <cstddef>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
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

// Scale and offset of a model's output, of which w is computed before.
class Scale {
public:
    Scale(double forgetting, double patience, double spread, double least, double most,
          bool scale_held, bool offset_held)
        : config_{forgetting, patience, spread, least, most, scale_held, offset_held} {}

    // In the order of the core's structure; exports write them down.
    std::vector<double> constants() const {
        return {config_.forgetting, config_.patience, config_.spread, config_.least, config_.most};
    }

    std::map<std::string, std::size_t> places() const {
        return {{"start", HYST_SCALE_START},
                {"start_offset", HYST_SCALE_START_OFFSET},
                {"scale", HYST_SCALE_SCALE},
                {"offset", HYST_SCALE_OFFSET},
                {"variance", HYST_SCALE_VARIANCE},
                {"mean_variance", HYST_SCALE_MEAN_VARIANCE},
                {"slope_variance", HYST_SCALE_SLOPE_VARIANCE},
                {"error", HYST_SCALE_ERROR},
                {"noise", HYST_SCALE_NOISE},
                {"noise_samples", HYST_SCALE_NOISE_SAMPLES},
                {"product", HYST_SCALE_PRODUCT},
                {"wide_slope", HYST_SCALE_WIDE_SLOPE},
                {"wide_mean", HYST_SCALE_WIDE_MEAN},
                {"wide_samples", HYST_SCALE_WIDE_SAMPLES},
                {"weight", HYST_SCALE_WEIGHT},
                {"mean_w", HYST_SCALE_MEAN_W},
                {"ww", HYST_SCALE_WW},
                {"wy", HYST_SCALE_WY},
                {"slope_weight", HYST_SCALE_SLOPE_WEIGHT},
                {"used", HYST_SCALE_USED},
                {"skipped", HYST_SCALE_SKIPPED},
                {"refused", HYST_SCALE_REFUSED},
                {"block", HYST_SCALE_BLOCK},
                {"length", HYST_SCALE_LENGTH}};
    }
    void start(State state, double start, double offset) const {
        hyst_scale_start(&config_, checked(state), start, offset);
    }
    int step(State state, double w, double y) const {
        return hyst_scale_step(&config_, checked(state), w, y);
    }
    // A row of scale and offset and of their variances after every `every` samples.
    void run(State state, Signal w, Signal y, std::size_t every, Rows theta, Rows variance,
             State error) const {
        double *values = checked(state);
        const std::size_t samples = w.shape(0);
        require(y.shape(0) == samples && error.shape(0) == samples, "w, y and error differ in length");
        require(every > 0 && theta.shape(0) == samples / every && theta.shape(1) == 2 &&
                    variance.shape(0) == theta.shape(0) && variance.shape(1) == 2,
                "theta and variance have the wrong shape");
        nb::gil_scoped_release unlocked;
        for (std::size_t k = 0; k < samples; ++k) {
            const int end = hyst_scale_step(&config_, values, w.data()[k], y.data()[k]);
            error.data()[k] = end == HYST_SCALE_UPDATED ? values[HYST_SCALE_ERROR] : 0.0;
            if ((k + 1) % every != 0) continue;
            const std::size_t at = 2 * (k / every);
            theta.data()[at] = values[HYST_SCALE_SCALE];
            theta.data()[at + 1] = values[HYST_SCALE_OFFSET];
            const double mean = values[HYST_SCALE_MEAN_W];
            variance.data()[at] = values[HYST_SCALE_VARIANCE];
            // Before there is an error nothing is known of their size.
            variance.data()[at + 1] =
                values[HYST_SCALE_NOISE_SAMPLES] > 0.0
                    ? values[HYST_SCALE_MEAN_VARIANCE] + mean * mean * values[HYST_SCALE_VARIANCE]
                    : std::numeric_limits<double>::quiet_NaN();
        }
    }

private:
    double *checked(const State &state) const {
        require(state.shape(0) == HYST_SCALE_LENGTH, "state has the wrong length");
        return state.data();
    }

    hyst_scale config_;
};

}  // namespace

void bind_scale_estimation(nb::module_ &module) {
    nb::class_<Scale>(module, "ScaleEstimation")
        .def(nb::init<double, double, double, double, double, bool, bool>())
        .def("places", &Scale::places)
        .def("constants", &Scale::constants)
        .def("start", &Scale::start, nb::arg("state").noconvert(), nb::arg("start"),
             nb::arg("offset"))
        .def("step", &Scale::step, nb::arg("state").noconvert(), nb::arg("w"), nb::arg("y"))
        .def("run", &Scale::run, nb::arg("state").noconvert(), nb::arg("w").noconvert(),
             nb::arg("y").noconvert(), nb::arg("every"), nb::arg("theta").noconvert(),
             nb::arg("variance").noconvert(), nb::arg("error").noconvert());
}

}  // namespace hyst
