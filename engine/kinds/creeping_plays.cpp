// Plays whose outputs creep, and their inverse.
#include "hyst/creeping_plays.h"

#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

// The bank that undoes plays of ascending thresholds: weights and thresholds (S1 eqs. 7-8).
void add_inverse_bank(const hyst_real &p0, const Reals &p, const Reals &r, Constants &made) {
    Reals weights, thresholds;
    hyst_real before = p0;  // the sum of the weights of the plays that move
    for (std::size_t j = 0; j < p.size(); ++j) {
        const hyst_real last = j > 0 ? r[j - 1] : hyst_real(0.0);
        const hyst_real reached = j > 0 ? thresholds[j - 1] : hyst_real(0.0);
        thresholds.push_back(reached + before * (r[j] - last));
        const hyst_real after = before + p[j];
        weights.push_back(-(p[j] / (before * after)));
        before = after;
    }
    made.table("back_p", std::move(weights), not_offered);
    made.table("back_r", std::move(thresholds), not_offered);
}

// p0, p, r, weights play after play, time constants, s.
void derive_creeping_plays(const Given &given, Constants &made) {
    const std::size_t plays = given.choices.at("plays"), lags = given.choices.at("lags");
    given.require(given.constants.size() == 1 + plays * (2 + lags) + lags && given.dt > 0.0);
    const hyst_real p0 = given.constants[0];
    const Reals p = given.part(1, plays), r = given.part(1 + plays, plays);
    const std::size_t inverse = given.choices.at("inverse");
    made.number("back_p0", inverse != 0 ? hyst_real(1.0) / p0 : hyst_real(0.0), not_offered);
    add_inverse_bank(p0, inverse != 0 ? p : Reals(), inverse != 0 ? r : Reals(), made);
    Reals gain = given.part(1 + plays * (2 + lags), lags);
    for (hyst_real &each : gain) each = hyst_creep_gain(each / hyst_real(given.dt));
    made.number("p0", p0, not_offered);
    made.table("p", p, not_offered);
    made.table("r", r, not_offered);
    made.table("weight", given.part(1 + 2 * plays, plays * lags), not_offered);
    made.table("gain", std::move(gain), not_offered);
    made.choose("inverse", inverse);
    made.structure =
        "hyst_creeping_plays $model = {{#p, $p0, $p, $r}, {#back_p, $back_p0, $back_p, $back_r}, "
        "#gain, $weight, $gain, $inverse};";
}

const void *fill_creeping_plays(Constants &of) {
    return of.hold(hyst_creeping_plays{
        {of.size("p"), of.number("p0"), of.table("p"), of.table("r")},
        {of.size("back_p"), of.number("back_p0"), of.table("back_p"), of.table("back_r")},
        of.size("gain"),
        of.table("weight"),
        of.table("gain"),
        of.is("inverse")});
}

}  // namespace

extern const Kind creeping_plays;

const Kind creeping_plays = {
    "creeping_plays",
    &hyst_creeping_plays_kind,
    derive_creeping_plays,
    fill_creeping_plays,
    {"hyst/creeping_plays.h", "$signal = hyst_creeping_plays_step(&$model, $memory, $signal);"},
    nullptr,
    nullptr,
    nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
