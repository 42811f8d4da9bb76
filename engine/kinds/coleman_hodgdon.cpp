// The hysteresis of Coleman and Hodgdon and its inverse.
#include "hyst/coleman_hodgdon.h"

#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

// alpha, a, b, u_s. That b <= a, and what the inverse needs, no single entry shows: none is offered.
void derive_coleman_hodgdon(const Given &given, Constants &made) {
    const std::size_t pieces = given.choices.at("pieces");
    given.require(pieces > 0 && given.constants.size() == 3 * pieces);
    made.number("alpha", given.constants[0], not_offered);
    made.table("a", given.part(1, pieces), not_offered);
    made.table("b", given.part(1 + pieces, pieces), not_offered);
    made.table("knot", given.part(1 + 2 * pieces, pieces - 1), not_offered);
    made.choose("inverse", given.choices.at("inverse"));
    made.structure = "hyst_coleman_hodgdon $model = {$alpha, #a, $a, $b, $knot, $inverse};";
}

const void *fill_coleman_hodgdon(Constants &of) {
    return of.hold(hyst_coleman_hodgdon{of.number("alpha"), of.size("a"), of.table("a"),
                                        of.table("b"), of.table("knot"), of.is("inverse")});
}

}  // namespace

extern const Kind coleman_hodgdon;

const Kind coleman_hodgdon = {
    "coleman_hodgdon",
    &hyst_coleman_hodgdon_kind,
    derive_coleman_hodgdon,
    fill_coleman_hodgdon,
    {"hyst/coleman_hodgdon.h", "$signal = hyst_coleman_hodgdon_step(&$model, $memory, $signal);"},
    nullptr,
    nullptr,
    nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
