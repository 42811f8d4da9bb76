// A play as wide as a power of the rate of its input.
#include "hyst/rate_shift.h"

#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

// c, m.
void derive_rate_shift(const Given &given, Constants &made) {
    given.require(given.constants.size() == 2);
    made.number("shift", given.constants[0], {Offer::threshold, "shift at a rate of 1"});
    made.number("exponent", given.constants[1], {Offer::fixed, "exponent of the rate"});
    made.number("per_time", hyst_real(1.0) / hyst_real(given.dt), not_offered);
    made.structure = "hyst_rate_shift $model = {$shift, $exponent, $per_time};";
}

const void *fill_rate_shift(Constants &of) {
    return of.hold(hyst_rate_shift{of.number("shift"), of.number("exponent"), of.number("per_time")});
}

}  // namespace

extern const Kind rate_shift;

const Kind rate_shift = {
    "rate_shift",
    &hyst_rate_shift_kind,
    derive_rate_shift,
    fill_rate_shift,
    {"hyst/rate_shift.h", "$signal = hyst_rate_shift_step(&$model, $memory, $signal);"},
    nullptr,
    nullptr,
    nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
