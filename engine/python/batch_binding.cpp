// Arguments are checked in Python; what is checked here is only that nothing is read or written outside
// an array.
#include "batch_binding.hpp"

#include <nanobind/ndarray.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "../records/batch.hpp"

namespace nb = nanobind;

namespace hyst {
namespace {

using Vector = nb::ndarray<double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Signal = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Matrix = nb::ndarray<double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Rows = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

void require(bool holds, const char *message) {
    if (!holds) throw std::invalid_argument(message);
}

template <class Array>
std::vector<Array> all(const nb::list &given) {
    std::vector<Array> arrays;
    for (nb::handle each : given) arrays.push_back(nb::cast<Array>(each, /* convert = */ false));
    return arrays;
}

// One for each job, or one for all.
const Signal &of(const std::vector<Signal> &records, std::size_t job) {
    return records[records.size() == 1 ? 0 : job];
}

// theta: no rows where all jobs have the constants of the chain.
Batch batch_of(const Chain &chain, const Rows &theta, const Signal &state,
               const std::vector<Signal> &records, std::size_t jobs, std::size_t threads) {
    require(theta.shape(1) == chain.parameter_count() &&
                (theta.shape(0) == 0 || theta.shape(0) == jobs),
            "theta has the wrong shape");
    require(state.shape(0) == chain.state_length(), "state has the wrong length");
    require(records.size() == 1 || records.size() == jobs, "records and jobs differ");
    return {chain, theta.shape(0) == 0 ? nullptr : theta.data(), state.data(), jobs, threads};
}

// The first job that could not be done and its first bad sample; or -1, -1.
nb::tuple run(const Chain &chain, Rows theta, Signal state, const nb::list &u, const nb::list &y,
              std::size_t threads) {
    const std::vector<Signal> records = all<Signal>(u);
    const std::vector<Vector> outputs = all<Vector>(y);
    const Batch batch = batch_of(chain, theta, state, records, outputs.size(), threads);
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        require(outputs[i].shape(0) == of(records, i).shape(0), "y must have the length of u");
    }
    std::vector<std::size_t> taken(outputs.size());
    {
        const nb::gil_scoped_release released;
        batch.each([&](std::size_t job, const Chain &own, double *memory) {
            const Signal &record = of(records, job);
            taken[job] = evaluate(own, memory, record.data(), outputs[job].data(), 1,
                                  record.shape(0), {}, nullptr);
        });
    }
    for (std::size_t job = 0; job < taken.size(); ++job) {
        if (taken[job] < outputs[job].shape(0)) return nb::make_tuple(job, taken[job]);
    }
    return nb::make_tuple(-1, -1);
}

void losses(const Chain &chain, Rows theta, Signal state, const nb::list &u, const nb::list &y,
            Vector loss, Matrix gradient, std::size_t threads) {
    const std::vector<Signal> records = all<Signal>(u), targets = all<Signal>(y);
    const std::size_t jobs = loss.shape(0);
    const Batch batch = batch_of(chain, theta, state, records, jobs, threads);
    require(targets.size() == 1 || targets.size() == jobs, "targets and jobs differ");
    require(gradient.shape(0) == jobs && gradient.shape(1) == chain.parameter_count(),
            "the gradients have the wrong shape");
    for (std::size_t i = 0; i < jobs; ++i) {
        require(of(targets, i).shape(0) == of(records, i).shape(0), "a target has another length");
    }
    const nb::gil_scoped_release released;
    batch.each([&](std::size_t job, const Chain &own, double *memory) {
        const Signal &record = of(records, job);
        loss(job) = loss_gradient(own, memory, record.data(), of(targets, job).data(),
                                  record.shape(0), {}, gradient.data() + job * gradient.shape(1));
    });
}

}  // namespace

void bind_batches(nb::module_ &module) {
    module.def("run_batch", &run, nb::arg("chain"), nb::arg("theta").noconvert(),
               nb::arg("state").noconvert(), nb::arg("u"), nb::arg("y"), nb::arg("threads") = 1);
    module.def("loss_batch", &losses, nb::arg("chain"), nb::arg("theta").noconvert(),
               nb::arg("state").noconvert(), nb::arg("u"), nb::arg("y"),
               nb::arg("loss").noconvert(), nb::arg("gradient").noconvert(),
               nb::arg("threads") = 1);
}

}  // namespace hyst
