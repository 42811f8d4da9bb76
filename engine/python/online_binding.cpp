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
    bind_radius_estimation(module);
    bind_scale_estimation(module);
}

}  // namespace hyst
