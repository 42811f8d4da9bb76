// Bouc-Wen's model and its inverse.
#include "hyst/bouc_wen.h"

#include "hyst/bouc_wen_branch.h"
#include "hyst/power.h"

#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

// One direction of the input: the limit of z, the rate of the way to it, and how much unloading is steeper.
void derive_side(Constants &made, const std::string &name, const Reals &of, hyst_real held) {
    const hyst_real a = of[1], n = of[4];
    const hyst_real limit = hyst_power(a / held, hyst_real(1.0) / n);
    made.number(name + "_limit", limit, not_offered);
    made.number(name + "_rate", a / limit, not_offered);
    made.number(name + "_ratio", (of[2] - of[3]) / held, not_offered);
}

// k, A, beta, gamma, n, phi.
void derive_bouc_wen(const Given &given, Constants &made) {
    given.require(given.constants.size() == 6);
    const Reals &of = given.constants;
    const hyst_real sum = of[2] + of[3], twice = of[5] + of[5];
    made.number("stiffness", of[0], not_offered);
    made.number("share", given.kept("h")[0], not_offered);
    made.number("exponent", of[4], not_offered);
    made.number("join", hyst_bouc_wen_join(of[4]), not_offered);
    derive_side(made, "up", of, sum + twice);
    derive_side(made, "down", of, sum - twice);
    made.choose("inverse", given.choices.at("inverse"));
    made.structure =
        "hyst_bouc_wen $model = {$stiffness, $share, $exponent, $join, {$up_limit, $up_rate, "
        "$up_ratio}, {$down_limit, $down_rate, $down_ratio}, $inverse};";
}

hyst_bouc_wen_side side(const Constants &of, const char *limit, const char *rate, const char *ratio) {
    return {of.number(limit), of.number(rate), of.number(ratio)};
}

const void *fill_bouc_wen(Constants &of) {
    return of.hold(hyst_bouc_wen{of.number("stiffness"), of.number("share"), of.number("exponent"),
                                 of.number("join"), side(of, "up_limit", "up_rate", "up_ratio"),
                                 side(of, "down_limit", "down_rate", "down_ratio"),
                                 of.is("inverse")});
}

}  // namespace

extern const Kind bouc_wen;

const Kind bouc_wen = {"bouc_wen",
                       &hyst_bouc_wen_kind,
                       derive_bouc_wen,
                       fill_bouc_wen,
                       {"hyst/bouc_wen.h", "$signal = hyst_bouc_wen_step(&$model, $memory, $signal);"},
                       nullptr,
                       nullptr,
                       nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
