// Inverses that keep the memory of the model they invert; they take its constants.
#include "hyst/solved.h"

#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

// As of affine, dead_zone and pi. Nothing is offered: that they can be solved, no single entry shows.
void derive_affine_solved(const Given &given, Constants &made) {
    given.require(given.constants.size() == 2);
    made.number("gain", given.constants[0], not_offered);
    made.number("offset", given.constants[1], not_offered);
    made.structure = "hyst_affine $model = {$gain, $offset};";
}

const void *fill_affine_solved(Constants &of) {
    return of.hold(hyst_affine{of.number("gain"), of.number("offset")});
}

void derive_dead_zone_solved(const Given &given, Constants &made) {
    const std::size_t count = given.constants.size() / 2;
    given.require(given.constants.size() == 2 * count);
    made.table("weight", given.part(0, count), not_offered);
    made.table("threshold", given.part(count, count), not_offered);
    made.structure = "hyst_dead_zone $model = {#weight, $weight, $threshold};";
}

const void *fill_dead_zone_solved(Constants &of) {
    return of.hold(hyst_dead_zone{of.size("weight"), of.table("weight"), of.table("threshold")});
}

void derive_pi_solved(const Given &given, Constants &made) {
    const std::size_t plays = given.constants.size() / 2;
    given.require(given.constants.size() == 1 + 2 * plays);
    made.number("p0", given.constants[0], not_offered);
    made.table("p", given.part(1, plays), not_offered);
    made.table("r", given.part(1 + plays, plays), not_offered);
    made.structure = "hyst_pi $model = {#p, $p0, $p, $r};";
}

const void *fill_pi_solved(Constants &of) {
    return of.hold(hyst_pi{of.size("p"), of.number("p0"), of.table("p"), of.table("r")});
}

}  // namespace

extern const Kind affine_solved, dead_zone_solved, pi_solved;

const Kind affine_solved = {
    "affine_solved",
    &hyst_affine_solved_kind,
    derive_affine_solved,
    fill_affine_solved,
    {"hyst/solved.h", "$signal = hyst_affine_solved_step(&$model, $signal);"},
    nullptr,
    nullptr,
    nullptr};

const Kind dead_zone_solved = {
    "dead_zone_solved",
    &hyst_dead_zone_solved_kind,
    derive_dead_zone_solved,
    fill_dead_zone_solved,
    {"hyst/solved.h", "$signal = hyst_dead_zone_solved_step(&$model, $signal);"},
    nullptr,
    nullptr,
    nullptr};

const Kind pi_solved = {
    "pi_solved",
    &hyst_pi_solved_kind,
    derive_pi_solved,
    fill_pi_solved,
    {"hyst/solved.h", "$signal = hyst_pi_solved_step(&$model, $memory, $signal);"},
    nullptr,
    nullptr,
    nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
