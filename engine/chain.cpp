#include "chain.hpp"

#include <algorithm>

namespace hyst {

Chain::Chain(const std::vector<kinds::Given> &stages) : given_(stages) {
    for (const kinds::Given &given : given_) {
        const kinds::Kind &kind = kinds::known_kind(given.kind);
        constants_.emplace_back();
        const void *model = kinds::build(kind, given, constants_.back());
        stages_.push_back({&kind, model, given.dt, given.constants.size()});
        core_.push_back(stages_.back().core());
    }
}

void Chain::set_parameters(const double *values) {
    for (std::size_t i = 0; i < given_.size(); ++i) {
        kinds::Reals &own = given_[i].constants;
        std::copy(values, values + own.size(), own.begin());
        values += own.size();
        constants_[i] = kinds::Constants();
        stages_[i].model = kinds::build(*stages_[i].kind, given_[i], constants_[i]);
        core_[i] = stages_[i].core();
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
