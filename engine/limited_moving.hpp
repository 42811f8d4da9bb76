// A chain whose constants follow a second signal and whose drive is limited: what a target runs, in the
// number type of this translation unit. The state belongs to whoever steps it.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "limited_drive.hpp"
#include "moving.hpp"

namespace hyst {

// A model, or an inverse and the model in front of which it is.
class LimitedMoving {
public:
    // `forward` has no stages for a model.
    LimitedMoving(const kinds::Reals &at, const std::vector<Moving::Stages> &own,
                  const std::vector<Moving::Stages> &forward, bool is_inverse,
                  hyst_drive_limits limits)
        : own_(at, own), forward_(at, forward), is_inverse_(is_inverse), limits_(limits),
          before_(own_.state_length()) {}

    std::size_t state_length() const {
        return own_.state_length() + (is_inverse_ ? forward_.state_length() : 0) + 1;
    }
    // To be called before the first sample: a bad one is answered with the drive of the state.
    void begin(const hyst_real *state) {
        if (is_inverse_) guard.guard.y_last = state[state_length() - 1];
    }
    // One sample of anything.
    hyst_real step(hyst_real *state, hyst_real x, hyst_real s) {
        if (hyst_is_finite(s)) {
            if (own_.set(s) != 0) outside = 1;
            (void)forward_.set(s);
        } else {
            x = s;
        }
        return limited().step(state, before_.data(), &guard, x);
    }
    // Takes the memory to where the drive leaves an actuator; false where that cannot be answered.
    bool lead(hyst_real *state, hyst_real drive, hyst_real s) {
        (void)own_.set(s);
        (void)forward_.set(s);
        return limited().lead(state, drive) != 0;
    }
    void clear_fault() { guard.guard.fault = guard.limited = outside = 0; }

    hyst_limited_guard guard{};
    int outside = 0;

private:
    LimitedDrive limited() const {
        const auto way = is_inverse_ ? LimitedDrive::Way::forward : LimitedDrive::Way::model;
        return {way, own_.view(), forward_.view(), limits_};
    }

    Moving own_, forward_;
    bool is_inverse_;
    hyst_drive_limits limits_;
    std::vector<hyst_real> before_;
};

}  // namespace hyst
