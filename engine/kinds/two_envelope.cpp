// Generalized plays between two envelopes, and their inverse.
#include "hyst/two_envelope.h"

#include <algorithm>

#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

// Weights and thresholds of the envelope of rising input, those of the other one, p0, p, r.
void derive_two_envelope(const Given &given, Constants &made) {
    const std::size_t up = given.choices.at("rising"), down = given.choices.at("falling");
    const std::size_t plays_at = 2 * (up + down);
    given.require(given.constants.size() > plays_at);
    const std::size_t plays = (given.constants.size() - plays_at) / 2;
    given.require(given.constants.size() == plays_at + 1 + 2 * plays);
    const bool inverse = given.choices.at("inverse") != 0;
    Reals knot{HYST_REAL(0.0)};
    for (const Reals &each : {given.part(up, up), given.part(2 * up + down, down)}) {
        for (const hyst_real &rho : each) {
            if (rho != HYST_REAL(0.0)) knot.push_back(rho);
        }
    }
    std::sort(knot.begin(), knot.end());
    made.table("up_weight", given.part(0, up), not_offered);
    made.table("up_threshold", given.part(up, up), not_offered);
    made.table("down_weight", given.part(2 * up, down), not_offered);
    made.table("down_threshold", given.part(2 * up + down, down), not_offered);
    made.number("p0", given.constants[plays_at],
                inverse ? not_offered : Offer{Offer::tunable, "weight of the mean of the envelopes"});
    made.table("p", given.part(plays_at + 1, plays),
               inverse ? not_offered : Offer{Offer::tunable, "weight of a play"});
    made.table("r", given.part(plays_at + 1 + plays, plays), not_offered);
    made.table("knot", std::move(knot), not_offered);
    made.choose("inverse", given.choices.at("inverse"));
    made.structure =
        "hyst_two_envelope $model = {#p, $p0, $p, $r, {#up_weight, $up_weight, $up_threshold}, "
        "{#down_weight, $down_weight, $down_threshold}, #knot, $knot, $inverse};";
}

const void *fill_two_envelope(Constants &of) {
    return of.hold(hyst_two_envelope{
        of.size("p"),
        of.number("p0"),
        of.table("p"),
        of.table("r"),
        {of.size("up_weight"), of.table("up_weight"), of.table("up_threshold")},
        {of.size("down_weight"), of.table("down_weight"), of.table("down_threshold")},
        of.size("knot"),
        of.table("knot"),
        of.is("inverse")});
}

}  // namespace

extern const Kind two_envelope;

const Kind two_envelope = {
    "two_envelope",
    &hyst_two_envelope_kind,
    derive_two_envelope,
    fill_two_envelope,
    {"hyst/two_envelope.h", "$signal = hyst_two_envelope_step(&$model, $memory, $signal);"},
    nullptr,
    nullptr,
    nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
