#include "jacobian.hpp"

#include <vector>

#include "dual/derivative.hpp"

namespace hyst {

void jacobian(const Chain &chain, double *state, const double *u, std::size_t samples,
              Derivative derivative, double *jacobian) {
    std::vector<double> signal(u, u + samples);
    Tangents tangents{signal.data(), samples, jacobian, chain.parameter_count(), 0};
    for (std::size_t i = 0; i < chain.stages().size(); ++i) {
        const Stage &stage = chain.stages()[i];
        if (derivative == Derivative::kernel || stage.kind->jacobian == nullptr) {
            const kinds::Given &given = chain.given(i);
            kernel_jacobian({given.kind, given.form, given.constants, given.fixed, given.choices,
                             given.dt},
                            state, tangents);
        } else {
            stage.kind->jacobian(stage.model, stage.dt, state, tangents);
        }
        tangents.incoming += stage.parameters;
        state += stage.state_length();
    }
}

}  // namespace hyst
