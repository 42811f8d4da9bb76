// Memory elements.
#include "hyst/memory_element.h"

#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

// c1 c2 c3; a_0 .. a_n; or the values of a table at fixed knots.
void derive_memory_element(const Given &given, Constants &made) {
    made.form = given.form == "power-law"    ? "HYST_MEMORY_POWER"
                : given.form == "polynomial" ? "HYST_MEMORY_POLYNOMIAL"
                                             : "HYST_MEMORY_TABLE";
    if (made.form == "HYST_MEMORY_TABLE" && given.form != "table") {
        throw std::invalid_argument("unknown memory function '" + given.form + "'");
    }
    Reals knots = given.kept("knots");
    given.require(given.form == "power-law" ? given.constants.size() == 3
                  : given.form == "table"   ? given.constants.size() == knots.size()
                                            : !given.constants.empty());
    made.number("reset_to", given.kept("reset_to").at(0), not_offered);
    made.number("dt", given.dt, not_offered);
    made.table("knot", std::move(knots), not_offered);
    made.table("value", given.constants, not_offered);
    for (const char *each : {"inverse", "absolute", "is_reset"}) {
        made.choose(each, given.choices.at(each));
    }
    made.structure =
        "hyst_memory_element $model = {{$form, #value, $knot, $value}, $inverse, $absolute, "
        "$is_reset, $reset_to, $dt};";
}

hyst_memory_kind function_of(const std::string &form) {
    if (form == "HYST_MEMORY_TABLE") return HYST_MEMORY_TABLE;
    return form == "HYST_MEMORY_POLYNOMIAL" ? HYST_MEMORY_POLYNOMIAL : HYST_MEMORY_POWER;
}

const void *fill_memory_element(Constants &of) {
    return of.hold(hyst_memory_element{
        {function_of(of.form), of.size("value"), of.table("knot"), of.table("value")},
        of.is("inverse"),
        of.is("absolute"),
        of.is("is_reset"),
        of.number("reset_to"),
        of.number("dt")});
}

}  // namespace

extern const Kind memory_element;

const Kind memory_element = {
    "memory_element",
    &hyst_memory_element_kind,
    derive_memory_element,
    fill_memory_element,
    {"hyst/memory_element.h", "$signal = hyst_memory_element_step(&$model, $memory, $signal);"},
    nullptr,
    nullptr,
    nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
