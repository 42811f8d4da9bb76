// A chain as a closed loop steps it: where each stage's state begins is found once, and banks of plays
// are stepped without a call. The bits are those of hyst_chain_step.
#pragma once

#include <vector>

#include "../chain.hpp"
#include "hyst/bank.h"

namespace hyst {

class FlatChain {
public:
    // Chain and state must outlive this.
    FlatChain(const Chain &chain, double *state) {
        for (const Stage &stage : chain.stages()) {
            const kinds::Plays *plays = stage.kind->plays;
            const hyst_pi *bank = plays == nullptr ? nullptr : plays->bank(stage.model);
            steps_.push_back({bank, stage.kind->core->step, stage.model, state});
            state += stage.state_length();
        }
    }
    double step(double u) const {
        for (const Step &each : steps_) {
            u = each.bank != nullptr
                    ? hyst_bank_step(each.bank, each.state, u, u, each.bank->p0 * u)
                    : each.call(each.model, each.state, u);
        }
        return u;
    }

private:
    struct Step {
        const hyst_pi *bank;  // or null
        double (*call)(const void *model, double *state, double u);
        const void *model;
        double *state;
    };
    std::vector<Step> steps_;
};

}  // namespace hyst
