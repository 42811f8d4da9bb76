// Bouc-Wen's model that degrades and pinches, and its inverse.
#include "hyst/degrading_bouc_wen.h"

#include "hyst/power.h"

#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

// k, A, beta, gamma, n, delta_nu, delta_eta, zeta, p, q, psi, delta_psi, lambda.
void derive_degrading_bouc_wen(const Given &given, Constants &made) {
    given.require(given.constants.size() == 13);
    const Reals &of = given.constants;
    const hyst_real sum = of[2] + of[3];
    const hyst_real limit = hyst_power(of[1] / sum, hyst_real(1.0) / of[4]);
    const hyst_real energy = limit / of[1] * limit;
    made.number("stiffness", of[0], not_offered);
    made.number("limit", limit, not_offered);
    made.number("rate", of[1] / limit, not_offered);
    made.number("exponent", of[4], not_offered);
    made.number("ratio", (of[2] - of[3]) / sum, not_offered);
    made.number("delta_nu", of[5] * energy, not_offered);
    made.number("delta_eta", of[6] * energy, not_offered);
    made.number("zeta", of[7], not_offered);
    made.number("p", of[8] * energy, not_offered);
    made.number("q", of[9], not_offered);
    made.number("psi", of[10] / limit, not_offered);
    made.number("delta_psi", of[11] * energy / limit, not_offered);
    made.number("lambda", of[12], not_offered);
    made.choose("inverse", given.choices.at("inverse"));
    made.structure =
        "hyst_degrading_bouc_wen $model = {$stiffness, $limit, $rate, {$exponent, $ratio, $delta_nu, "
        "$delta_eta, $zeta, $p, $q, $psi, $delta_psi, $lambda}, $inverse};";
}

const void *fill_degrading_bouc_wen(Constants &of) {
    const hyst_degrading loop = {of.number("exponent"),  of.number("ratio"), of.number("delta_nu"),
                                 of.number("delta_eta"), of.number("zeta"),  of.number("p"),
                                 of.number("q"),         of.number("psi"),   of.number("delta_psi"),
                                 of.number("lambda")};
    return of.hold(hyst_degrading_bouc_wen{of.number("stiffness"), of.number("limit"),
                                           of.number("rate"), loop, of.is("inverse")});
}

}  // namespace

extern const Kind degrading_bouc_wen;

const Kind degrading_bouc_wen = {
    "degrading_bouc_wen",
    &hyst_degrading_bouc_wen_kind,
    derive_degrading_bouc_wen,
    fill_degrading_bouc_wen,
    {"hyst/degrading_bouc_wen.h",
     "$signal = hyst_degrading_bouc_wen_step(&$model, $memory, $signal);"},
    nullptr,
    nullptr,
    nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
