// Stages inside a stage, whose output and input are mapped together onto the output.
#include "hyst/state_map.h"

#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

// The constants of the stages inside, one after the other, then c_00 .. c_0n, c_10 .. of the map.
void derive_state_map(const Given &given, Constants &made) {
    std::size_t first = 0;
    for (Given each : given.inside) {
        each.constants = given.part(first, each.constants.size());
        first += each.constants.size();
        made.inside.push_back({&known_kind(each.kind), {}});
        made.inside.back().kind->derive(each, made.inside.back().constants);
    }
    const std::size_t degree = given.choices.at("degree");
    given.require(given.constants.size() == first + (degree + 1) * (degree + 2) / 2);
    made.choose("degree", degree);
    made.table("coefficient", given.part(first, given.constants.size() - first),
               {Offer::tunable, "coefficient of a power of the input times one of the hysteresis"});
    made.structure = "hyst_state_polynomial $model = {#degree, $coefficient};";
}

const void *fill_state_map(Constants &of) {
    of.stages.clear();
    for (Inside &each : of.inside) {
        of.stages.push_back({each.kind->core, each.kind->fill(each.constants)});
    }
    return of.hold(hyst_state_map{{of.stages.size(), of.stages.data()},
                                  {of.choice("degree"), of.table("coefficient")}});
}

}  // namespace

extern const Kind state_map;

const Kind state_map = {
    "state_map",
    &hyst_state_map_kind,
    derive_state_map,
    fill_state_map,
    {"hyst/state_polynomial.h",
     "$signal = hyst_state_polynomial_value(&$model, $input, $signal);"},
    nullptr,
    nullptr,
    nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
