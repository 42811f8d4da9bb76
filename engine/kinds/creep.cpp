// Creep and its inverse.
#include "hyst/creep.h"

#include "fast/creep.hpp"
#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

// The weights, then the time constants, s. The memory of a lag is in the units of the signal: a weight
// may change at any time, a time constant where it changes no stability, which nothing here shows.
void derive_creep(const Given &given, Constants &made) {
    const std::size_t lags = given.constants.size() / 2;
    given.require(given.constants.size() == 2 * lags && given.dt > 0.0);
    Reals gain = given.part(lags, lags);
    for (hyst_real &each : gain) {
        each = hyst_creep_gain(each / hyst_real(given.dt));
    }
    made.table("weight", given.part(0, lags), not_offered);
    made.table("gain", std::move(gain), not_offered);
    made.choose("inverse", given.choices.at("inverse"));
    made.structure = "hyst_creep $model = {#gain, $weight, $gain, $inverse};";
}

const void *fill_creep(Constants &of) {
    return of.hold(
        hyst_creep{of.size("gain"), of.table("weight"), of.table("gain"), of.is("inverse")});
}

}  // namespace

extern const Kind creep;

const Kind creep = {"creep",
                    &hyst_creep_kind,
                    derive_creep,
                    fill_creep,
                    {"hyst/creep.h", "$signal = hyst_creep_step(&$model, $memory, $signal);"},
                    nullptr,
                    HYST_IN_DOUBLE(run_creep),
                    nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
