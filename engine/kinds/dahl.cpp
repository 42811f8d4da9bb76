// Dahl's friction and its inverse.
#include "hyst/dahl.h"

#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

// sigma, Fc, n. The memory is the share of Fc and depends on the way through all three.
void derive_dahl(const Given &given, Constants &made) {
    given.require(given.constants.size() == 3);
    const hyst_real sigma = given.constants[0], force = given.constants[1];
    made.number("force", force, {Offer::threshold, "Coulomb force"});
    made.number("rate", sigma / force, {Offer::threshold, "stiffness at rest over Coulomb force"});
    made.number("excess", given.constants[2] - hyst_real(1.0), not_offered);
    made.choose("inverse", given.choices.at("inverse"));
    made.structure = "hyst_dahl $model = {$force, $rate, $excess, $inverse};";
}

const void *fill_dahl(Constants &of) {
    return of.hold(
        hyst_dahl{of.number("force"), of.number("rate"), of.number("excess"), of.is("inverse")});
}

}  // namespace

extern const Kind dahl;

const Kind dahl = {"dahl",
                   &hyst_dahl_kind,
                   derive_dahl,
                   fill_dahl,
                   {"hyst/dahl.h", "$signal = hyst_dahl_step(&$model, $memory, $signal);"},
                   nullptr,
                   nullptr,
                   nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
