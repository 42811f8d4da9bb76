// Maps without memory, or with that of the last input alone: affine maps and dead zones.
#include "fast/maps.hpp"
#include "hyst/affine.h"
#include "hyst/dead_zone.h"
#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

void derive_affine(const Given &given, Constants &made) {
    given.require(given.constants.size() == 2);
    made.number("gain", given.constants[0], {Offer::tunable, "gain"});
    made.number("offset", given.constants[1], {Offer::tunable, "offset"});
}

const void *fill_affine(Constants &of) {
    return of.hold(hyst_affine{of.number("gain"), of.number("offset")});
}

void derive_dead_zone(const Given &given, Constants &made) {
    const std::size_t count = given.constants.size() / 2;
    given.require(given.constants.size() == 2 * count);
    made.table("weight", given.part(0, count), {Offer::tunable, "weight of a dead zone"});
    made.table("threshold", given.part(count, count), {Offer::tunable, "threshold of a dead zone"});
    made.structure = "hyst_dead_zone $model = {#weight, $weight, $threshold};";
}

const void *fill_dead_zone(Constants &of) {
    return of.hold(hyst_dead_zone{of.size("weight"), of.table("weight"), of.table("threshold")});
}

}  // namespace

extern const Kind affine, dead_zone, direction_dead_zone;

const Kind affine = {"affine",
                     &hyst_affine_kind,
                     derive_affine,
                     fill_affine,
                     {"", "$signal = $gain * $signal + $offset;"},
                     HYST_IN_DOUBLE(affine_jacobian),
                     HYST_IN_DOUBLE(run_affine),
                     nullptr};

const Kind dead_zone = {"dead_zone",
                        &hyst_dead_zone_kind,
                        derive_dead_zone,
                        fill_dead_zone,
                        {"hyst/dead_zone.h", "$signal = hyst_dead_zone_step(&$model, $signal);"},
                        HYST_IN_DOUBLE(dead_zone_jacobian),
                        HYST_IN_DOUBLE(run_dead_zone),
                        nullptr};

const Kind direction_dead_zone = {
    "direction_dead_zone",
    &hyst_direction_dead_zone_kind,
    derive_dead_zone,
    fill_dead_zone,
    {"hyst/dead_zone.h",
     "$signal = hyst_direction_dead_zone_step(&$model, $memory, $signal);"},
    HYST_IN_DOUBLE(direction_dead_zone_jacobian),
    nullptr,
    nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
