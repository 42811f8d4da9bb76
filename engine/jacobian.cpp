#include "jacobian.hpp"

#include <vector>

#include "said.hpp"

namespace hyst {

void jacobian(const Chain &chain, double *state, const double *u, std::size_t samples,
              Derivative derivative, double *jacobian) {
    std::vector<double> signal(u, u + samples);
    Tangents tangents{signal.data(), samples, jacobian, chain.parameter_count(), 0};
    for (std::size_t i = 0; i < chain.stages().size(); ++i) {
        const Stage &stage = chain.stages()[i];
        if (derivative == Derivative::kernel || stage.kind->jacobian == nullptr) {
            kernel_jacobian(said_of(chain.given(i)), {state, nullptr, 0}, stage.state_length(), tangents);
        } else {
            stage.kind->jacobian(stage.model, stage.dt, state, tangents);
        }
        tangents.incoming += stage.parameters;
        state += stage.state_length();
    }
}

void carry_jacobian(const Chain &chain, double *state, double *memory, double *signal,
                    std::size_t samples, double *jacobian) {
    const std::size_t stride = chain.parameter_count();
    Tangents tangents{signal, samples, jacobian, stride, 0};
    for (std::size_t i = 0; i < chain.stages().size(); ++i) {
        const Stage &stage = chain.stages()[i];
        const std::size_t length = stage.state_length();
        if (length == 0 && stage.kind->jacobian != nullptr) {  // nothing to carry
            stage.kind->jacobian(stage.model, stage.dt, state, tangents);
        } else {
            kernel_jacobian(said_of(chain.given(i)), {state, memory, stride}, length, tangents);
        }
        tangents.incoming += stage.parameters;
        state += length;
        memory += length * stride;
    }
}

}  // namespace hyst
