// Plays, stops and banks of plays.
#include "hyst/play.h"

#include "fast/plays.hpp"
#include "hyst/rate_dependent_prandtl_ishlinskii.h"
#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

constexpr Offer threshold{Offer::threshold, "threshold of a play"};

void derive_play(const Given &given, Constants &made) {
    given.require(given.constants.size() == 1);
    made.number("r", given.constants[0], threshold);
}

const void *fill_play(Constants &of) { return of.hold(of.number("r")); }

void add_bank(const Given &given, std::size_t plays, Constants &made) {
    made.table("p", given.part(1, plays), {Offer::tunable, "weight of a play"});
    made.table("r", given.part(1 + plays, plays), threshold);
}

constexpr Offer linear_part{Offer::tunable, "weight of the input itself"};

void derive_pi(const Given &given, Constants &made) {
    const std::size_t plays = given.constants.size() / 2;
    given.require(given.constants.size() == 1 + 2 * plays);
    made.number("p0", given.constants[0], linear_part);
    add_bank(given, plays, made);
    made.structure = "hyst_pi $model = {#p, $p0, $p, $r};";
}

hyst_pi bank_of(Constants &of) {
    return {of.size("p"), of.number("p0"), of.table("p"), of.table("r")};
}

const void *fill_pi(Constants &of) { return of.hold(bank_of(of)); }

// Maxwell-slip: k0, stiffnesses k, breakaway forces f of stops, which are plays taken from springs:
// p0 = k0 + sum k, p = -k, r = f / k.
void derive_maxwell_slip(const Given &given, Constants &made) {
    const std::size_t elements = given.constants.size() / 2;
    given.require(given.constants.size() == 1 + 2 * elements);
    Reals p = given.part(1, elements), r = given.part(1 + elements, elements);
    hyst_real p0 = given.constants[0];
    for (std::size_t i = 0; i < elements; ++i) {
        p0 = p0 + p[i];
        r[i] = r[i] / p[i];
        p[i] = -p[i];
    }
    made.number("p0", p0, linear_part);
    made.table("p", std::move(p), {Offer::tunable, "weight of a play"});
    made.table("r", std::move(r), threshold);
    made.structure = "hyst_pi $model = {#p, $p0, $p, $r};";
}

// p0 p r beta powers slopes; the knees are fixed. The core's curve is over the change of the input in
// one sample, x dt, so what is over the rate is scaled by dt.
void derive_rate_dependent_pi(const Given &given, Constants &made) {
    const std::size_t plays = given.choices.at("plays"), powers = given.choices.at("powers");
    const hyst_real dt = given.dt;
    Reals knees = given.kept("knees");
    given.require(given.constants.size() == 2 + 2 * plays + powers + knees.size());
    const std::size_t beta = 1 + 2 * plays;
    Reals power = given.part(beta + 1, powers);
    Reals slopes = given.part(beta + 1 + powers, knees.size());
    hyst_real scale = dt;
    for (hyst_real &each : power) {
        scale = scale * dt;
        each = each / scale;
    }
    for (hyst_real &slope : slopes) slope = slope / dt;
    for (hyst_real &knee : knees) knee = knee * dt;
    made.number("p0", given.constants[0], linear_part);
    made.number("growth", given.constants[beta] / dt,
                {Offer::threshold,
                 "growth of the thresholds with the change of the input in a sample"});
    add_bank(given, plays, made);
    made.table("power", std::move(power),
               {Offer::fixed, "further growth of the thresholds with a power of that change"});
    made.table("weight", std::move(slopes), {Offer::fixed, "weight of a dead zone"});
    made.table("threshold", std::move(knees), {Offer::threshold, "threshold of a dead zone"});
    made.structure =
        "hyst_rate_dependent_pi $model = {{#p, $p0, $p, $r}, $growth, #power, $power, "
        "{#weight, $weight, $threshold}};";
}

const void *fill_rate_dependent_pi(Constants &of) {
    return of.hold(hyst_rate_dependent_pi{
        bank_of(of),
        of.number("growth"),
        of.size("power"),
        of.table("power"),
        {of.size("weight"), of.table("weight"), of.table("threshold")}});
}

}  // namespace

extern const Kind play, stop, pi, maxwell_slip, rate_dependent_pi;

const Kind play = {"play",
                   &hyst_play_kind,
                   derive_play,
                   fill_play,
                   {"hyst/play.h", "$signal = hyst_play_step($r, $memory, $signal);"},
                   HYST_IN_DOUBLE(play_jacobian),
                   nullptr,
                   HYST_IN_DOUBLE(&lanes_of_play),
                   HYST_IN_DOUBLE(play_reverse)};

const Kind stop = {"stop",
                   &hyst_stop_kind,
                   derive_play,
                   fill_play,
                   {"hyst/play.h", "$signal = hyst_stop_step($r, $memory, $signal);"},
                   HYST_IN_DOUBLE(stop_jacobian),
                   nullptr,
                   HYST_IN_DOUBLE(&lanes_of_stop),
                   HYST_IN_DOUBLE(stop_reverse)};

const Kind pi = {
    "pi",
    &hyst_pi_kind,
    derive_pi,
    fill_pi,
    {"hyst/prandtl_ishlinskii.h", "$signal = hyst_pi_step(&$model, $memory, $signal);"},
    HYST_IN_DOUBLE(pi_jacobian),
    nullptr,
    HYST_IN_DOUBLE(&lanes_of_pi),
    HYST_IN_DOUBLE(pi_reverse)};

const Kind maxwell_slip = {
    "maxwell_slip",
    &hyst_pi_kind,
    derive_maxwell_slip,
    fill_pi,
    {"hyst/prandtl_ishlinskii.h", "$signal = hyst_pi_step(&$model, $memory, $signal);"},
    nullptr,
    nullptr,
    HYST_IN_DOUBLE(&lanes_of_pi)};

const Kind rate_dependent_pi = {
    "rate_dependent_pi",
    &hyst_rate_dependent_pi_kind,
    derive_rate_dependent_pi,
    fill_rate_dependent_pi,
    {"hyst/rate_dependent_prandtl_ishlinskii.h",
     "$signal = hyst_rate_dependent_pi_step(&$model, $memory, $signal);"},
    HYST_IN_DOUBLE(rate_dependent_pi_jacobian),
    nullptr,
    HYST_IN_DOUBLE(&lanes_of_rate_dependent_pi)};

}  // namespace HYST_KINDS
}  // namespace hyst
