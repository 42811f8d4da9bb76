#include "rate_dependent_binding.hpp"

#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>

#include <cstdint>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "../chain.hpp"
#include "../tasks/sample_exact.hpp"
#include "../tasks/trajectory_polish.hpp"
#include "../tasks/trajectory_step.hpp"

namespace nb = nanobind;

namespace hyst {
namespace {

using Vector = nb::ndarray<double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Signal = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

const hyst_rate_dependent_pi &plays_of(const Chain &chain, std::size_t state_length) {
    if (chain.stages().size() != 1 || chain.stages()[0].kind != &kinds::rate_dependent_pi) {
        throw std::invalid_argument("the chain must be one bank of rate-dependent plays");
    }
    const auto &plays = *static_cast<const hyst_rate_dependent_pi *>(chain.stages()[0].model);
    if (state_length != plays.pi.count + 2) {
        throw std::invalid_argument("state has the wrong length");
    }
    return plays;
}

TrajectoryTask task_of(const Chain &chain, const Signal &state, const Signal &target,
                       const Signal &u, double roughness, const Rounding &rounding,
                       const Limits &limits) {
    const hyst_rate_dependent_pi &plays = plays_of(chain, state.shape(0));
    if (u.shape(0) != target.shape(0)) throw std::invalid_argument("u and target differ in length");
    return {plays, state.data(), target.data(), u.shape(0), roughness, rounding, limits};
}

double cost(const Chain &chain, Signal state, Signal target, Signal u, double roughness,
            const Rounding &rounding, const Limits &limits) {
    const TrajectoryTask task = task_of(chain, state, target, u, roughness, rounding, limits);
    const nb::gil_scoped_release released;
    return trajectory_cost(task, u.data());
}

double step(const Chain &chain, Signal state, Signal target, Signal u, double roughness,
            const Rounding &rounding, const Limits &limits, double damping, Vector result) {
    const TrajectoryTask task = task_of(chain, state, target, u, roughness, rounding, limits);
    if (result.shape(0) != task.samples) throw std::invalid_argument("the step has a wrong length");
    const nb::gil_scoped_release released;
    return trajectory_step(task, u.data(), damping, result.data());
}

TrackingGoal goal_of(const Chain &chain, const Signal &state, const Signal &target,
                     std::size_t samples, const TrackingTerms &terms) {
    const hyst_rate_dependent_pi &plays = plays_of(chain, state.shape(0));
    if (samples != target.shape(0)) throw std::invalid_argument("u and target differ in length");
    return {plays, state.data(), target.data(), samples, terms};
}

double tracked(const Chain &chain, Signal state, Signal target, Signal u,
               const TrackingTerms &terms, Vector gradient) {
    const TrackingGoal goal = goal_of(chain, state, target, u.shape(0), terms);
    if (gradient.shape(0) != goal.samples) throw std::invalid_argument("wrong gradient length");
    const nb::gil_scoped_release released;
    return tracking_gradient(goal, u.data(), gradient.data());
}

std::tuple<double, double, std::size_t> polish(const Chain &chain, Signal state, Signal target, Vector u,
                                               const TrackingTerms &terms, const Polish &how) {
    const TrackingGoal goal = goal_of(chain, state, target, u.shape(0), terms);
    const nb::gil_scoped_release released;
    const Polished done = trajectory_polish(goal, how, u.data());
    return {done.before, done.after, done.cut_off};
}

std::pair<std::size_t, std::size_t> exact(const Chain &chain, Vector state, Signal target,
                                          Vector u, double low, double high) {
    const hyst_rate_dependent_pi &plays = plays_of(chain, state.shape(0));
    if (u.shape(0) != target.shape(0)) throw std::invalid_argument("u and target differ in length");
    const nb::gil_scoped_release released;
    const SampleExact result =
        sample_exact(plays, state.data(), target.data(), u.data(), target.shape(0), low, high);
    return {result.solved, result.several};
}

}  // namespace

void bind_rate_dependent_inversion(nb::module_ &module) {
    nb::class_<Rounding>(module, "Rounding")
        .def("__init__", [](Rounding *made, double rate, double contact) {
            new (made) Rounding{rate, contact};
        });
    nb::class_<Limits>(module, "Limits")
        .def("__init__",
             [](Limits *made, double low, double high, double change, double penalty) {
                 new (made) Limits{low, high, change, penalty};
             });
    nb::class_<TrackingTerms>(module, "TrackingTerms")
        .def("__init__",
             [](TrackingTerms *made, double low, double high, double change, unsigned power,
                double scale, double roughness, double stray) {
                 if (power == 0 || power % 2 == 1) throw std::invalid_argument("power is odd");
                 new (made) TrackingTerms{low, high, change, power, scale, roughness, stray};
             });
    nb::class_<Polish>(module, "Polish")
        .def("__init__",
             [](Polish *made, std::size_t window, std::size_t follow, std::size_t trials,
                std::size_t steps, double least, double size, std::uint64_t seed) {
                 new (made) Polish{window, follow, trials, steps, least, size, seed};
             });
    module.def("tracking_gradient", &tracked, nb::arg("chain"), nb::arg("state"),
               nb::arg("target"), nb::arg("u"), nb::arg("terms"), nb::arg("gradient").noconvert());
    module.def("trajectory_polish", &polish, nb::arg("chain"), nb::arg("state"), nb::arg("target"),
               nb::arg("u").noconvert(), nb::arg("terms"), nb::arg("how"));
    module.def("trajectory_cost", &cost);
    module.def("trajectory_step", &step, nb::arg("chain"), nb::arg("state"), nb::arg("target"),
               nb::arg("u"), nb::arg("roughness"), nb::arg("rounding"), nb::arg("limits"),
               nb::arg("damping"), nb::arg("result").noconvert());
    module.def("sample_exact", &exact, nb::arg("chain"), nb::arg("state").noconvert(),
               nb::arg("target"), nb::arg("u").noconvert(), nb::arg("low"), nb::arg("high"));
}

}  // namespace hyst
