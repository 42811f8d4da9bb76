// The hysteresis of Jiles and Atherton and its inverse.
#include "hyst/jiles_atherton.h"
#include "hyst/power.h"

#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

// Of a sub-step, over the shorter of a and k; see docs/jiles_atherton.md for what it leaves.
const double width_of_sub_step = 0.25;
// Of sub-steps, over the longer of a and k.
const double reach_of_sub_steps = 300.0;

hyst_jiles_variant variant_of(const std::string &form) {
    if (form == "HYST_JILES_1992") return HYST_JILES_1992;
    if (form == "HYST_JILES_1986") return HYST_JILES_1986;
    return HYST_JILES_EFFECTIVE_FIELD;
}

// Ms a k c alpha, and with losses k_cl and k_ex; mu0 is fixed. That alpha Ms < 3 a no single entry shows,
// so nothing is offered.
void derive_jiles_atherton(const Given &given, Constants &made) {
    const bool loses = given.constants.size() == 7;
    given.require(given.constants.size() == 5 || (loses && given.dt > 0.0));
    const hyst_real saturation = given.constants[0], shape = given.constants[1];
    const hyst_real pinning = given.constants[2], c = given.constants[3];
    const hyst_real eta = given.constants[4] * saturation / shape;
    const hyst_real kappa = shape / pinning;
    const bool is_flux = given.choices.at("flux") != 0;
    const hyst_real mu0 = given.kept("mu0").at(0);
    made.form = given.form == "jiles-thoelke-devine-1992" ? "HYST_JILES_1992"
                : given.form == "jiles-atherton-1986"     ? "HYST_JILES_1986"
                                                          : "HYST_JILES_EFFECTIVE_FIELD";
    const hyst_real one = hyst_real(1.0);
    // Over which way a branch is forgotten; in 1992's denominator 1 - eta kappa c X stays above 1 - c.
    const hyst_real slowness = (given.form == "jiles-atherton-1986" ? one + c : one) / kappa;
    const hyst_real quickest = given.form == "jiles-thoelke-devine-1992" ? (one - c) / kappa : slowness;
    made.number("eta", eta, not_offered);
    made.number("kappa", kappa, not_offered);
    made.number("c", c, not_offered);
    made.number("field", shape, not_offered);
    const hyst_real level = is_flux ? mu0 * shape : saturation;
    made.number("level", level, not_offered);
    made.number("x_share", is_flux ? one : hyst_real(0.0), not_offered);
    made.number("m_share", is_flux ? saturation / shape - eta : one, not_offered);
    made.number("width", hyst_real(width_of_sub_step) * (quickest < one ? quickest : one),
                not_offered);
    made.number("reach", hyst_real(reach_of_sub_steps) * (slowness > one ? slowness : one),
                not_offered);
    hyst_real eddy = hyst_real(0.0), excess = hyst_real(0.0);
    if (loses) {
        eddy = given.constants[5] * (level / hyst_real(given.dt)) / shape;
        excess = given.constants[6] * hyst_power(level / hyst_real(given.dt), hyst_real(0.5)) / shape;
    }
    made.choose("loses", loses ? 1 : 0);
    made.number("eddy", eddy, not_offered);
    made.number("excess", excess, not_offered);
    made.choose("inverse", given.choices.at("inverse"));
    made.structure =
        "hyst_jiles_atherton $model = {$form, $eta, $kappa, $c, $field, $level, $x_share, $m_share, "
        "$width, $reach, $loses, $eddy, $excess, $inverse};";
}

const void *fill_jiles_atherton(Constants &of) {
    return of.hold(hyst_jiles_atherton{
        variant_of(of.form), of.number("eta"), of.number("kappa"), of.number("c"),
        of.number("field"), of.number("level"), of.number("x_share"), of.number("m_share"),
        of.number("width"), of.number("reach"),
        of.is("loses"), of.number("eddy"), of.number("excess"), of.is("inverse")});
}

}  // namespace

extern const Kind jiles_atherton;

const Kind jiles_atherton = {
    "jiles_atherton",
    &hyst_jiles_atherton_kind,
    derive_jiles_atherton,
    fill_jiles_atherton,
    {"hyst/jiles_atherton.h", "$signal = hyst_jiles_atherton_step(&$model, $memory, $signal);"},
    nullptr,
    nullptr,
    nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
