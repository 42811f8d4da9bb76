// A first-order lag and its inverse.
#include "hyst/lag.h"

#include "fast/creep.hpp"
#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

// The time constant, s. Its memory is in the units of the signal, but which inverse is stable is not
// shown by any single entry, so nothing is offered.
void derive_lag(const Given &given, Constants &made) {
    given.require(given.constants.size() == 1 && given.dt > 0.0);
    const hyst_real samples = given.constants[0] / hyst_real(given.dt);
    const hyst_real gain = hyst_creep_gain(samples);
    const hyst_real through = given.choices.at("held") != 0 ? gain : hyst_lag_through(samples);
    made.number("gain", gain, not_offered);
    made.number("through", through, not_offered);
    made.number("per_through", hyst_real(1.0) / through, not_offered);
    made.choose("inverse", given.choices.at("inverse"));
    made.structure = "hyst_lag $model = {$gain, $through, $per_through, $inverse};";
}

const void *fill_lag(Constants &of) {
    return of.hold(hyst_lag{of.number("gain"), of.number("through"), of.number("per_through"),
                            of.is("inverse")});
}

}  // namespace

extern const Kind lag;

const Kind lag = {"lag",
                  &hyst_lag_kind,
                  derive_lag,
                  fill_lag,
                  {"hyst/lag.h", "$signal = hyst_lag_step(&$model, $memory, $signal);"},
                  nullptr,
                  HYST_IN_DOUBLE(run_lag),
                  nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
