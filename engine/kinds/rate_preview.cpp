// Inverse of a bank of rate-dependent plays that knows the next samples.
#include "hyst/rate_preview.h"

#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

// The constants are the core's own, of the model and of its explicit inverse, whose curve over the
// change of a sample has as many powers and knees. Nothing may change while it runs: the plan and the
// memory belong to all of them.
void derive_rate_preview(const Given &given, Constants &made) {
    given.require(given.constants.empty() && given.dt > 0.0);
    for (const char *each : {"p", "r", "power", "weight", "threshold", "guess_p", "guess_r",
                             "guess_power", "guess_weight", "guess_threshold"}) {
        made.table(each, given.kept(each), not_offered);
    }
    for (const char *each :
         {"p0", "growth", "guess_p0", "guess_growth", "low", "high", "change"}) {
        made.number(each, given.kept(each).at(0), not_offered);
    }
    for (const char *each : {"preview", "ranged", "slowed"}) {
        made.choose(each, given.choices.at(each));
    }
    made.structure =
        "hyst_rate_preview $model = {{{#p, $p0, $p, $r}, $growth, #power, $power, "
        "{#weight, $weight, $threshold}}, "
        "{{#guess_p, $guess_p0, $guess_p, $guess_r}, $guess_growth, #guess_power, $guess_power, "
        "{#guess_weight, $guess_weight, $guess_threshold}}, "
        "#preview, $ranged, $low, $high, $slowed, $change};";
}

const void *fill_rate_preview(Constants &of) {
    const hyst_rate_dependent_pi plays{
        {of.size("p"), of.number("p0"), of.table("p"), of.table("r")},
        of.number("growth"),
        of.size("power"),
        of.table("power"),
        {of.size("weight"), of.table("weight"), of.table("threshold")}};
    const hyst_rate_dependent_pi guess{
        {of.size("guess_p"), of.number("guess_p0"), of.table("guess_p"), of.table("guess_r")},
        of.number("guess_growth"),
        of.size("guess_power"),
        of.table("guess_power"),
        {of.size("guess_weight"), of.table("guess_weight"), of.table("guess_threshold")}};
    return of.hold(hyst_rate_preview{plays, guess, of.choice("preview"), of.is("ranged"),
                                     of.number("low"), of.number("high"), of.is("slowed"),
                                     of.number("change")});
}

}  // namespace

extern const Kind rate_preview;

const Kind rate_preview = {
    "rate_preview",
    &hyst_rate_preview_kind,
    derive_rate_preview,
    fill_rate_preview,
    {"hyst/rate_preview.h", "$signal = hyst_rate_preview_step(&$model, $memory, $signal);"},
    nullptr,
    nullptr,
    nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
