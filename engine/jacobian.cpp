#include "jacobian.hpp"

#include <stdexcept>
#include <string>
#include <vector>

namespace hyst {

void jacobian(const Chain &chain, double *state, const double *u, std::size_t samples,
              double *jacobian) {
    std::vector<double> signal(u, u + samples);
    Tangents tangents{signal.data(), samples, jacobian, chain.parameter_count(), 0};
    for (const Stage &stage : chain.stages()) {
        if (stage.kind->jacobian == nullptr) {
            throw std::invalid_argument(std::string("a stage of kind '") + stage.kind->name +
                                        "' has no derivative; add one to its row");
        }
        stage.kind->jacobian(stage.model, stage.dt, state, tangents);
        tangents.incoming += stage.parameters;
        state += stage.state_length();
    }
}

}  // namespace hyst
