// The estimators of the core, one sample or one record at a time. The state is a flat array that
// Python owns; what is checked here is only that nothing is written outside an array.
#include "online_binding.hpp"

#include "folded.hpp"

#include <nanobind/ndarray.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "hyst/hyst.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <new>
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

// Terms of a map, threshold 0 first, then the positive ones ascending, then the negative ones.
struct Map {
    std::vector<double> threshold;
    double least_slope, most_slope;

    hyst_joint_map view() const {
        std::size_t positive = 0;
        for (double each : threshold) positive += each > 0.0;
        return {threshold.size(), positive, threshold.data(), least_slope, most_slope};
    }
};

class Joint {
public:
    Joint(std::size_t plays, std::vector<double> limit, Map front, Map back)
        : limit_(std::move(limit)), front_(std::move(front)), back_(std::move(back)) {
        config_ = {};
        config_.plays = plays;
        config_.front = front_.view();
        config_.back = back_.view();
        config_.limit = limit_.data();
        places_ = hyst_joint_places(&config_);
        require(limit_.size() == places_.m, "limit must have one entry for each parameter");
        search_ = {};
        search_.joint = &config_;
        all_ = hyst_search_places(&search_);
    }
    Joint(const Joint &) = delete;
    Joint &operator=(const Joint &) = delete;

    void set_bounds(double least_slope, double most_slope, double most_radius) {
        config_.least_slope = least_slope;
        config_.most_slope = most_slope;
        config_.most_radius = most_radius;
    }
    void set_memory(double forgetting, double noise_memory, double least_noise,
                    double least_share, double patience) {
        config_.forgetting = forgetting;
        config_.noise_memory = noise_memory;
        config_.least_noise = least_noise;
        config_.least_share = least_share;
        config_.patience = patience;
    }
    // Cells of fixed radii, from which rivals of the estimate come.
    void set_search(std::vector<double> radius, std::vector<double> start,
                    std::vector<double> limit, double noise) {
        require(start.size() == radius.size() + 2 && limit.size() == start.size(),
                "start and limit must have two entries more than radius");
        require(radius.size() >= config_.plays, "there must be as many cells as plays");
        cell_radius_ = std::move(radius);
        cell_start_ = std::move(start);
        cell_limit_ = std::move(limit);
        search_ = {&config_,           cell_radius_.size(), cell_radius_.data(),
                   cell_start_.data(), cell_limit_.data(),  noise};
        all_ = hyst_search_places(&search_);
    }
    std::map<std::string, std::size_t> places() const {
        return {{"m", places_.m},       {"theta", places_.theta}, {"d", places_.d},
                {"u", places_.u},       {"z", places_.z},         {"side", places_.side},
                {"age", places_.age},   {"home", places_.home},   {"far", places_.far},
                {"psi", places_.psi},   {"scratch", places_.scratch},
                {"scalars", all_.scalars}, {"rival", all_.rival}, {"cells", all_.weight},
                {"cell_memory", all_.z},
                {"points", all_.point_weight}, {"length", all_.length}};
    }
    void start(State state, double noise) const {
        double *values = checked(state);
        hyst_joint_start(&config_, values, noise);
        hyst_search_start(&search_, values);
    }
    int step(State state, double u, double y) {
        const int end = hyst_search_step(&search_, checked(state), u, y);
        if (end == HYST_JOINT_UPDATED) folded_.take(u, y);
        return end;
    }
    // What is kept of the samples themselves, which the core does not need.
    void set_folding(double quantum, double coarsest, double most, double page) {
        folded_ = Folded(quantum, coarsest, most, page);
    }
    // A row for each input with its memory: count, mean y, squares about the means, turns and input;
    // of the present page (0), of the one before (1), or of both as one (2).
    std::vector<std::vector<double>> folded(int which) const {
        std::vector<std::vector<double>> rows;
        for (const FoldedRow &each : which == 2 ? folded_.both() : folded_.page(which == 1)) {
            rows.push_back({each.count, each.y, each.uu, each.uy, each.yy});
            rows.back().insert(rows.back().end(), each.way.begin(), each.way.begin() + each.size);
        }
        return rows;
    }
    std::vector<double> folding() const { return folded_.place(); }
    void fold_again(const std::vector<double> &place, const std::vector<std::vector<double>> &rows,
                    const std::vector<std::vector<double>> &before) {
        require(place.size() >= 6 && place[3] > 0.0, "the place has at least six numbers");
        folded_.restore(place, rows_of(rows), rows_of(before));
    }
    void unfold() { folded_.clear(); }
    // All that the core is told, by the names of its structures; exports write it down.
    std::map<std::string, std::vector<double>> constants() const {
        return {{"plays", {static_cast<double>(config_.plays)}},
                {"front", front_.threshold},
                {"front_slopes", {front_.least_slope, front_.most_slope}},
                {"back", back_.threshold},
                {"back_slopes", {back_.least_slope, back_.most_slope}},
                {"bounds", {config_.least_slope, config_.most_slope, config_.most_radius}},
                {"memory",
                 {config_.forgetting, config_.noise_memory, config_.least_noise,
                  config_.least_share, config_.patience}},
                {"limit", limit_},
                {"cell_radius", cell_radius_},
                {"cell_start", cell_start_},
                {"cell_limit", cell_limit_},
                {"cell_noise", {search_.noise}}};
    }
    double correlation(State state) const {
        return hyst_search_correlation(&search_, checked(state));
    }
    // The memory of the input, in terms of parameters that have been replaced.
    void remember(State state) const {
        double *values = checked(state);
        hyst_joint_set_memory(&config_, &places_, values, values[HYST_JOINT_INPUT]);
    }
    // The estimate has been replaced from outside.
    void replaced(State state) const {
        double *values = checked(state);
        hyst_joint_set_memory(&config_, &places_, values, values[HYST_JOINT_INPUT]);
        values[all_.scalars + HYST_SEARCH_SEEN] = 0.0;
    }
    // An input whose output was not measured.
    void follow(State state, double u) {
        hyst_search_follow(&search_, checked(state), u);
        folded_.follow(u);
    }
    double command(State state, double y_ref) const {
        return hyst_joint_command(&config_, checked(state), y_ref);
    }
    // A row of theta and of its variances after every `every` samples; all prediction errors.
    void run(State state, Signal u, Signal y, std::size_t every, Rows theta, Rows variance,
             State error) {
        double *values = checked(state);
        const std::size_t samples = u.shape(0);
        require(y.shape(0) == samples && error.shape(0) == samples, "u, y and error differ in length");
        require(every > 0 && theta.shape(0) == samples / every && theta.shape(1) == places_.m &&
                    variance.shape(0) == theta.shape(0) && variance.shape(1) == places_.m,
                "theta and variance have the wrong shape");
        nb::gil_scoped_release unlocked;
        for (std::size_t k = 0; k < samples; ++k) {
            const int end = hyst_search_step(&search_, values, u.data()[k], y.data()[k]);
            error.data()[k] = end == HYST_JOINT_UPDATED ? values[HYST_JOINT_ERROR] : 0.0;
            if (end == HYST_JOINT_UPDATED) folded_.take(u.data()[k], y.data()[k]);
            if ((k + 1) % every == 0) store(values, k / every, theta, variance);
        }
    }

private:
    double *checked(const State &state) const {
        require(state.shape(0) == all_.length, "state has the wrong length");
        return state.data();
    }
    static std::vector<FoldedRow> rows_of(const std::vector<std::vector<double>> &rows) {
        std::vector<FoldedRow> found;
        for (const std::vector<double> &each : rows) {
            require(each.size() >= 6 && each.size() <= 6 + most_turns, "a row has 6 to 13 numbers");
            FoldedRow row{each[0], each[1], each[2], each[3], each[4], each.size() - 5};
            std::copy(each.begin() + 5, each.end(), row.way.begin());
            found.push_back(row);
        }
        return found;
    }
    void store(const double *state, std::size_t row, const Rows &theta, const Rows &variance) const {
        const std::size_t m = places_.m;
        for (std::size_t j = 0; j < m; ++j) theta.data()[row * m + j] = state[places_.theta + j];
        hyst_ud_variances(m, state + places_.u, state + places_.d, variance.data() + row * m);
    }

    std::vector<double> limit_;
    Map front_, back_;
    hyst_joint config_;
    hyst_joint_layout places_;
    std::vector<double> cell_radius_, cell_start_, cell_limit_;
    hyst_search search_;
    hyst_search_layout all_;
    Folded folded_{1e-12, 1.0, 2048.0, 1e300};
};

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

void project_radii(State r, double most) {
    hyst_isotonic(r.shape(0), r.data(), 0.0, most);
}

}  // namespace

void bind_online_estimation(nb::module_ &module) {
    nb::class_<Joint>(module, "JointEstimation")
        .def("__init__",
             [](Joint *self, std::size_t plays, std::vector<double> limit, std::vector<double> front,
                std::vector<double> back, double least_map_slope, double most_map_slope) {
                 new (self) Joint(plays, std::move(limit),
                                  {std::move(front), least_map_slope, most_map_slope},
                                  {std::move(back), least_map_slope, most_map_slope});
             })
        .def("set_bounds", &Joint::set_bounds)
        .def("set_memory", &Joint::set_memory)
        .def("set_search", &Joint::set_search)
        .def("set_folding", &Joint::set_folding)
        .def("folded", &Joint::folded)
        .def("folding", &Joint::folding)
        .def("fold_again", &Joint::fold_again)
        .def("unfold", &Joint::unfold)
        .def("places", &Joint::places)
        .def("start", &Joint::start, nb::arg("state").noconvert(), nb::arg("noise"))
        .def("step", &Joint::step, nb::arg("state").noconvert(), nb::arg("u"), nb::arg("y"))
        .def("follow", &Joint::follow, nb::arg("state").noconvert(), nb::arg("u"))
        .def("remember", &Joint::remember, nb::arg("state").noconvert())
        .def("replaced", &Joint::replaced, nb::arg("state").noconvert())
        .def("constants", &Joint::constants)
        .def("correlation", &Joint::correlation, nb::arg("state").noconvert())
        .def("command", &Joint::command, nb::arg("state").noconvert(), nb::arg("y_ref"))
        .def("run", &Joint::run, nb::arg("state").noconvert(), nb::arg("u").noconvert(),
             nb::arg("y").noconvert(), nb::arg("every"), nb::arg("theta").noconvert(),
             nb::arg("variance").noconvert(), nb::arg("error").noconvert());
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
    module.def("project_radii", &project_radii, nb::arg("r").noconvert(), nb::arg("most"));
}

}  // namespace hyst
