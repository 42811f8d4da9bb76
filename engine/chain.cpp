#include "chain.hpp"

#include <stdexcept>

namespace hyst {

Chain::Chain(const std::vector<kinds::Given> &stages) : given_(stages) {
    for (const kinds::Given &given : stages) {
        const kinds::Kind *kind = kinds::kind_named(given.kind);
        if (kind == nullptr) {
            throw std::invalid_argument("unknown kind of stage '" + given.kind + "'");
        }
        constants_.emplace_back();
        const void *model = kinds::build(*kind, given, constants_.back());
        stages_.push_back({kind, model, given.dt, given.constants.size()});
        core_.push_back(stages_.back().core());
    }
}

std::size_t Chain::state_length() const {
    const hyst_chain chain = view();
    return hyst_chain_state_length(&chain);
}

std::size_t Chain::parameter_count() const {
    std::size_t count = 0;
    for (const Stage &stage : stages_) count += stage.parameters;
    return count;
}

void Chain::run(double *state, const double *u, double *y, std::size_t samples) const {
    const hyst_chain chain = view();
    hyst_chain_run(&chain, state, u, y, samples);
}

}  // namespace hyst
