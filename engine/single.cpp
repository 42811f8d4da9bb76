// The core in single precision: what an exported target computes, to the last bit. A module of its
// own, because a program links the core in one precision only.
#include <nanobind/nanobind.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <deque>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "hyst/hyst.h"

namespace nb = nanobind;

namespace {

static_assert(sizeof(hyst_real) == sizeof(float), "this module is for single precision");

using Numbers = std::map<std::string, double>;
using Tables = std::map<std::string, std::vector<double>>;
using Choices = std::map<std::string, std::size_t>;
// Kind, form, numbers, tables, choices: see hyst.export.stages.
using Description = std::tuple<std::string, std::string, Numbers, Tables, Choices>;

// Stages of the core together with the memory their constants live in.
class Constants {
public:
    explicit Constants(const Description &description) : description_(description) {}

    float number(const std::string &name) const {
        return static_cast<float>(std::get<2>(description_).at(name));
    }
    std::size_t choice(const std::string &name) const { return std::get<4>(description_).at(name); }
    int is(const std::string &name) const { return static_cast<int>(choice(name)); }
    std::size_t size(const std::string &name) const {
        return std::get<3>(description_).at(name).size();
    }
    const std::string &kind() const { return std::get<0>(description_); }
    const std::string &form() const { return std::get<1>(description_); }
    const float *table(const std::string &name, std::deque<std::vector<float>> &home) const {
        const std::vector<double> &values = std::get<3>(description_).at(name);
        home.emplace_back(values.begin(), values.end());
        return home.back().data();
    }

private:
    const Description &description_;
};

class Stepper {
public:
    Stepper(const std::vector<Description> &stages, const std::vector<double> &start)
        : state_(start.begin(), start.end()) {
        std::size_t length = 0;
        for (const Description &each : stages) {
            const Constants of(each);
            if (of.kind() == "tracking_controller") {
                add_controller(of);
                length += controller_.order;
            } else {
                stages_.push_back(stage(of));
                length += hyst_stage_state_length(&stages_.back());
            }
        }
        if (length != state_.size()) throw std::invalid_argument("start has the wrong length");
        controller_.inverse = {stages_.size(), stages_.data()};
    }
    Stepper(const Stepper &) = delete;
    Stepper &operator=(const Stepper &) = delete;

    double step(double u) {
        if (has_two_inputs_) throw std::invalid_argument("this block takes y_ref and y");
        return hyst_guarded_step(&controller_.inverse, state_.data(), &guard_,
                                 static_cast<float>(u));
    }
    double step_controller(double y_ref, double y) {
        if (!has_two_inputs_) throw std::invalid_argument("this block takes u");
        return hyst_guarded_tracking_step(&controller_, state_.data(), &guard_,
                                          static_cast<float>(y_ref), static_cast<float>(y));
    }
    std::vector<double> state() const { return {state_.begin(), state_.end()}; }
    bool fault() const { return guard_.fault != 0; }
    void clear_fault() { guard_.fault = 0; }

private:
    void add_controller(const Constants &of) {
        controller_ = {of.size("c"),
                       of.table("a", home_),
                       of.table("b", home_),
                       of.table("c", home_),
                       {of.number("d_y_ref"), of.number("d_y")},
                       {0, nullptr}};
        has_two_inputs_ = true;
    }

    hyst_pi plays(const Constants &of) {
        const float *p = of.table("p", home_);
        return {of.size("p"), of.number("p0"), p, of.table("r", home_)};
    }

    hyst_dead_zone ramps(const Constants &of) {
        const float *weight = of.table("weight", home_);
        return {of.size("weight"), weight, of.table("threshold", home_)};
    }

    hyst_stage stage(const Constants &of) {
        hyst_stage made{};
        const std::string &kind = of.kind();
        if (kind == "affine") {
            made.kind = HYST_AFFINE;
            made.as.affine = {of.number("gain"), of.number("offset")};
        } else if (kind == "play" || kind == "stop") {
            made.kind = kind == "play" ? HYST_PLAY : HYST_STOP;
            made.as.r = of.number("r");
        } else if (kind == "dead_zone" || kind == "direction_dead_zone") {
            made.kind = kind == "dead_zone" ? HYST_DEAD_ZONE : HYST_DIRECTION_DEAD_ZONE;
            made.as.dead_zone = ramps(of);
        } else if (kind == "pi") {
            made.kind = HYST_PI;
            made.as.pi = plays(of);
        } else if (kind == "rate_dependent_pi") {
            made.kind = HYST_RATE_DEPENDENT_PI;
            made.as.rate_dependent_pi = {plays(of), of.number("growth"), of.size("power"),
                                         of.table("power", home_), ramps(of)};
        } else {
            other(made, of);
        }
        return made;
    }

    void other(hyst_stage &made, const Constants &of) {
        const std::string &kind = of.kind();
        if (kind == "state_space") {
            const float *a = of.table("a", home_), *b = of.table("b", home_);
            made.kind = HYST_STATE_SPACE;
            made.as.state_space = {of.size("b"), of.choice("delay"), a, b, of.table("c", home_),
                                   of.number("d")};
        } else if (kind == "sections") {
            made.kind = HYST_SECTIONS;
            made.as.sections = {of.size("coefficient") / 5, of.table("coefficient", home_)};
        } else if (kind == "masing") {
            made.kind = HYST_MASING;
            made.as.masing = {curve(of), of.is("inverse"), of.is("last_reversal"),
                              of.choice("depth"), of.number("dead_band")};
        } else if (kind == "memory_element") {
            made.kind = HYST_MEMORY_ELEMENT;
            const float *knot = of.table("knot", home_);
            made.as.memory_element = {
                {function(of.form()), of.size("value"), knot, of.table("value", home_)},
                of.is("inverse"),
                of.is("absolute"),
                of.is("is_reset"),
                of.number("reset_to"),
                of.number("dt")};
        } else {
            throw std::invalid_argument("unknown kind of stage '" + kind + "'");
        }
    }

    hyst_loading_curve curve(const Constants &of) {
        hyst_loading_curve made{};
        if (of.form() == "HYST_POWER_LAW") {
            made.kind = HYST_POWER_LAW;
            made.as.power_law = {of.number("linear"), of.number("factor"), of.number("exponent")};
        } else if (of.form() == "HYST_PLAYS") {
            const float *knot = of.table("knot", home_), *value = of.table("value", home_);
            made.kind = HYST_PLAYS;
            made.as.pieces = {of.size("knot"), knot, value, of.table("slope", home_)};
        } else {
            made.kind = HYST_POLYNOMIAL;
            made.as.polynomial = {of.size("coefficient"), of.table("coefficient", home_),
                                  of.number("least_slope")};
        }
        return made;
    }

    static hyst_memory_kind function(const std::string &form) {
        if (form == "HYST_MEMORY_TABLE") return HYST_MEMORY_TABLE;
        return form == "HYST_MEMORY_POLYNOMIAL" ? HYST_MEMORY_POLYNOMIAL : HYST_MEMORY_POWER;
    }

    std::deque<std::vector<float>> home_;
    std::vector<hyst_stage> stages_;
    std::vector<float> state_;
    hyst_tracking_controller controller_{};
    hyst_guard guard_{};
    bool has_two_inputs_ = false;
};

// A joint estimator; the constants are those that the engine's estimator in double tells.
class Estimator {
public:
    Estimator(const Tables &constants, const std::vector<double> &start)
        : state_(start.begin(), start.end()) {
        const auto of = [&](const std::string &name) { return keep(constants.at(name)); };
        const float *bounds = of("bounds"), *memory = of("memory");
        joint_ = {static_cast<std::size_t>(constants.at("plays").at(0)),
                  map(constants, "front"),
                  map(constants, "back"),
                  bounds[0],
                  bounds[1],
                  bounds[2],
                  memory[0],
                  memory[1],
                  memory[2],
                  memory[3],
                  memory[4],
                  of("limit")};
        search_ = {&joint_,          constants.at("cell_radius").size(),
                   of("cell_radius"), of("cell_start"),
                   of("cell_limit"),  *of("cell_noise")};
        if (hyst_search_places(&search_).length != state_.size()) {
            throw std::invalid_argument("start has the wrong length");
        }
    }
    Estimator(const Estimator &) = delete;
    Estimator &operator=(const Estimator &) = delete;

    int step(double u, double y) {
        return hyst_search_step(&search_, state_.data(), static_cast<float>(u),
                                static_cast<float>(y));
    }
    double command(double y_ref) const {
        return hyst_joint_command(&joint_, state_.data(), static_cast<float>(y_ref));
    }
    std::vector<double> state() const { return {state_.begin(), state_.end()}; }

private:
    const float *keep(const std::vector<double> &values) {
        home_.emplace_back(values.begin(), values.end());
        return home_.back().data();
    }
    hyst_joint_map map(const Tables &constants, const std::string &name) {
        const std::vector<double> &threshold = constants.at(name);
        const float *slopes = keep(constants.at(name + "_slopes"));
        std::size_t positive = 0;
        for (double each : threshold) positive += each > 0.0;
        return {threshold.size(), positive, keep(threshold), slopes[0], slopes[1]};
    }

    std::deque<std::vector<float>> home_;
    std::vector<float> state_;
    hyst_joint joint_{};
    hyst_search search_{};
};

}  // namespace

NB_MODULE(_single, module) {
    nb::class_<Stepper>(module, "Stepper")
        .def(nb::init<const std::vector<Description> &, const std::vector<double> &>(),
             nb::arg("stages"), nb::arg("start"))
        .def("__call__", &Stepper::step, nb::arg("u"))
        .def("__call__", &Stepper::step_controller, nb::arg("y_ref"), nb::arg("y"))
        .def_prop_ro("state", &Stepper::state)
        .def_prop_ro("fault", &Stepper::fault)
        .def("clear_fault", &Stepper::clear_fault);
    nb::class_<Estimator>(module, "Estimator")
        .def(nb::init<const Tables &, const std::vector<double> &>(), nb::arg("constants"),
             nb::arg("start"))
        .def("step", &Estimator::step, nb::arg("u"), nb::arg("y"))
        .def("command", &Estimator::command, nb::arg("y_ref"))
        .def_prop_ro("state", &Estimator::state);
}
