// An inverse or a model whose drive is limited: what a target runs, in the number type of this
// translation unit. The chains are kept alive by whoever made them.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <vector>

#include "hyst/guard.h"
#include "hyst/limited_bank.h"
#include "hyst/limited_inverse.h"
#include "hyst/solved.h"

namespace hyst {

class LimitedDrive {
public:
    // The drive is the input of a model; the output of an inverse, beside which the model in front is
    // kept; or that of an inverse whose last stage is a bank of plays and whose others have no memory.
    enum class Way : std::size_t { model, forward, bank };

    LimitedDrive(Way way, hyst_chain chain, hyst_chain forward, hyst_drive_limits limits)
        : way_(way), inverse_{chain, forward, limits} {}

    LimitedDrive(hyst_chain chain, hyst_bank_limits limits)
        : way_(Way::bank), ends_(limits), inverse_{chain, {}, {limits.low, limits.high, 0}} {
        if (chain.count == 0 || chain.stage[chain.count - 1].kind->step != hyst_pi_kind.step) {
            throw std::invalid_argument("the last stage is no bank of plays");
        }
        front_ = {chain.count - 1, chain.stage};
        if (hyst_chain_state_length(&front_) != 0) {
            throw std::invalid_argument("a stage before the bank has a memory");
        }
        bank_ = static_cast<const hyst_pi *>(chain.stage[chain.count - 1].model);
    }

    std::size_t state_length() const {
        return way_ == Way::forward ? hyst_limited_inverse_state_length(&inverse_)
                                    : hyst_chain_state_length(&inverse_.inverse) + 1;
    }
    // What answers a first sample that is not finite.
    hyst_real start(const hyst_real *state) const {
        return way_ == Way::model ? hyst_real(0) : state[state_length() - 1];
    }

    // One sample of anything; before: room for a state.
    hyst_real step(hyst_real *state, hyst_real *before, hyst_limited_guard *guard, hyst_real x) const {
        if (way_ == Way::model) return step_model(state, guard, x);
        if (way_ == Way::bank) return step_bank(state, guard, x);
        return hyst_limited_inverse_step(&inverse_, state, before, guard, &x);
    }

    // Takes the memory to where the drive leaves an actuator; 0 where that cannot be answered.
    int lead(hyst_real *state, hyst_real drive) const {
        hyst_guard guard = {drive, 0};
        state[state_length() - 1] = drive;
        if (way_ == Way::bank) {
            return hyst_is_finite(hyst_pi_solved_step(bank_, state, drive));
        }
        if (way_ == Way::model) {
            (void)hyst_guarded_step(&inverse_.inverse, state, &guard, drive);
            return guard.fault == 0;
        }
        hyst_real *const memory = state + hyst_chain_state_length(&inverse_.inverse);
        const hyst_real v = hyst_guarded_step(&inverse_.forward, memory, &guard, drive);
        if (guard.fault == 0) (void)hyst_guarded_step(&inverse_.inverse, state, &guard, v);
        return guard.fault == 0;
    }

private:
    hyst_real step_model(hyst_real *state, hyst_limited_guard *guard, hyst_real u) const {
        if (!hyst_is_finite(u)) {
            guard->guard.fault = 1;
            return guard->guard.y_last;
        }
        const hyst_real drive =
            hyst_limited_drive(&inverse_.limits, state + (state_length() - 1), u);
        if (drive < u || drive > u) guard->limited = 1;
        return hyst_guarded_step(&inverse_.inverse, state, &guard->guard, drive);
    }

    hyst_real step_bank(hyst_real *state, hyst_limited_guard *guard, hyst_real v) const {
        if (!hyst_is_finite(v)) {
            guard->guard.fault = 1;
            return guard->guard.y_last;
        }
        hyst_guard front = {v, 0};
        const hyst_real inner = hyst_guarded_step(&front_, state, &front, v);
        if (front.fault != 0) {  // no drive belongs to v: the last one is kept
            guard->guard.fault = guard->limited = 1;
            return guard->guard.y_last = state[bank_->count];
        }
        return guard->guard.y_last =
                   hyst_limited_bank_step(bank_, &ends_, state, &guard->limited, inner);
    }

    Way way_;
    hyst_bank_limits ends_{};
    hyst_limited_inverse inverse_;
    hyst_chain front_{};
    const hyst_pi *bank_ = nullptr;
};

}  // namespace hyst
