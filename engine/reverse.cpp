#include "reverse.hpp"

#include <algorithm>
#include <vector>

#include "dual/reverse.hpp"
#include "records/evaluation.hpp"
#include "said.hpp"

namespace hyst {
namespace {

// What a stage needs on the way back: its input, and its states before every block.
struct Passed {
    std::vector<double> u, states;
    std::size_t block;
};

// A stage with more memory has longer blocks, so that all its states are no more than the record.
Passed pass(const Stage &stage, const double *state, std::vector<double> &signal) {
    const std::size_t samples = signal.size(), length = stage.state_length();
    Passed passed{signal, {}, std::max<std::size_t>(256, length)};
    std::vector<double> now(state, state + length);
    for (std::size_t k = 0; k < samples; k += passed.block) {
        passed.states.insert(passed.states.end(), now.begin(), now.end());
        const std::size_t count = std::min(passed.block, samples - k);
        evaluate_stage(stage, now.data(), &passed.u[k], &signal[k], count, {});
    }
    return passed;
}

}  // namespace

void reverse(const Chain &chain, const double *state, const double *u, std::size_t samples,
             double *signal, double *by_constants) {
    std::vector<Passed> passed;
    std::vector<double> forward(u, u + samples);
    for (const Stage &stage : chain.stages()) {
        passed.push_back(pass(stage, state, forward));
        state += stage.state_length();
    }
    by_constants += chain.parameter_count();
    for (std::size_t i = chain.stages().size(); i-- > 0;) {
        const Stage &stage = chain.stages()[i];
        by_constants -= stage.parameters;
        const Cotangents given{passed[i].u.data(), signal, samples, by_constants, passed[i].block,
                               passed[i].states.data()};
        if (stage.kind->reverse != nullptr) {
            stage.kind->reverse(stage.model, given);
        } else {
            kernel_reverse(said_of(chain.given(i)), stage.state_length(), given);
        }
        passed.pop_back();
    }
}

}  // namespace hyst
