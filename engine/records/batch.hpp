// Many models of one structure, many records.
#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <vector>

#include "evaluation.hpp"
#include "gradient.hpp"
#include "../parallel.hpp"

namespace hyst {

// Where constants differ, every thread has a chain of its own that is given those of its job.
class Batch {
public:
    // theta: one row of constants a job, or null where all have those of the chain. state: where each
    // job starts.
    Batch(const Chain &chain, const double *theta, const double *state, std::size_t jobs,
          std::size_t threads)
        : chain_(chain), theta_(theta), state_(state), jobs_(jobs),
          threads_(threads < jobs ? threads : jobs) {
        if (theta == nullptr) return;
        std::vector<kinds::Given> given;
        for (std::size_t i = 0; i < chain.stages().size(); ++i) given.push_back(chain.given(i));
        for (std::size_t i = 0; i < threads_; ++i) own_.push_back(std::make_unique<Chain>(given));
    }

    // work(job, chain, state) for each job, state a copy.
    template <class Work>
    void each(const Work &work) const {
        parallel(jobs_, threads_, [&](std::size_t job) {
            std::vector<double> state(state_, state_ + chain_.state_length());
            work(job, chain_of(job), state.data());
        });
    }

private:
    const Chain &chain_of(std::size_t job) const {
        if (theta_ == nullptr) return chain_;
        Chain &own = *own_[job % threads_];
        own.set_parameters(theta_ + job * chain_.parameter_count());
        if (own.state_length() != chain_.state_length()) {
            throw std::invalid_argument("constants change the length of the state");
        }
        return own;
    }
    const Chain &chain_;
    const double *theta_, *state_;
    std::size_t jobs_, threads_;
    std::vector<std::unique_ptr<Chain>> own_;
};

}  // namespace hyst
