// Friction over velocity: LuGre, and generalized Maxwell-slip.
#include "hyst/generalized_maxwell_slip.h"
#include "hyst/lugre.h"
#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

constexpr Offer of_memory{Offer::threshold, "constant of friction that its memory depends on"};

// Fc, Fs, vs of the Stribeck curve.
void add_stribeck(const Given &given, std::size_t at, Constants &made) {
    const hyst_real coulomb = given.constants[at];
    made.number("coulomb", coulomb, of_memory);
    made.number("excess", given.constants[at + 1] - coulomb, of_memory);
    made.number("slowness", hyst_real(1.0) / given.constants[at + 2], of_memory);
}

hyst_stribeck stribeck_of(Constants &of) {
    return {of.number("coulomb"), of.number("excess"), of.number("slowness")};
}

// sigma0, sigma1, sigma2, Fc, Fs, vs, Fv, vv.
void derive_lugre(const Given &given, Constants &made) {
    given.require(given.constants.size() == 8);
    made.number("stiffness", given.constants[0], of_memory);
    made.number("damping", given.constants[1], {Offer::tunable, "damping of the bristles"});
    made.number("viscosity", given.constants[2], {Offer::tunable, "viscous friction"});
    made.number("thinning", given.constants[6],
                {Offer::tunable, "what the viscous friction that saturates ends at"});
    made.number("thin", hyst_real(1.0) / given.constants[7], not_offered);
    add_stribeck(given, 3, made);
    made.number("rate", hyst_real(1.0) / given.dt, not_offered);
    made.structure =
        "hyst_lugre $model = {$stiffness, $damping, $viscosity, $thinning, $thin, {$coulomb, "
        "$excess, $slowness}, $rate};";
}

const void *fill_lugre(Constants &of) {
    return of.hold(hyst_lugre{of.number("stiffness"), of.number("damping"), of.number("viscosity"),
                              of.number("thinning"), of.number("thin"), stribeck_of(of),
                              of.number("rate")});
}

// k, alpha, C, Fc, Fs, vs, delta, sigma2.
void derive_generalized(const Given &given, Constants &made) {
    const std::size_t count = (given.constants.size() - 6) / 2;
    given.require(given.constants.size() == 6 + 2 * count);
    const std::size_t at = 2 * count;
    made.table("stiffness", given.part(0, count), {Offer::threshold, "stiffness of an element"});
    made.table("share", given.part(count, count),
               {Offer::threshold, "share of the Stribeck curve that an element bears"});
    add_stribeck(given, at + 1, made);
    made.number("shape", given.constants[at + 4], of_memory);
    made.number("attraction", given.constants[at] * given.dt, of_memory);
    made.number("viscosity", given.constants[at + 5], {Offer::tunable, "viscous friction"});
    made.number("rate", hyst_real(1.0) / given.dt, not_offered);
    made.structure =
        "hyst_generalized_maxwell_slip $model = {#stiffness, $stiffness, $share, {$coulomb, "
        "$excess, $slowness}, $shape, $attraction, $viscosity, $rate};";
}

const void *fill_generalized(Constants &of) {
    return of.hold(hyst_generalized_maxwell_slip{
        of.size("stiffness"), of.table("stiffness"), of.table("share"), stribeck_of(of),
        of.number("shape"), of.number("attraction"), of.number("viscosity"), of.number("rate")});
}

}  // namespace

extern const Kind lugre, generalized_maxwell_slip;

const Kind lugre = {"lugre",
                    &hyst_lugre_kind,
                    derive_lugre,
                    fill_lugre,
                    {"hyst/lugre.h", "$signal = hyst_lugre_step(&$model, $memory, $signal);"},
                    nullptr,
                    nullptr,
                    nullptr};

const Kind generalized_maxwell_slip = {
    "generalized_maxwell_slip",
    &hyst_generalized_maxwell_slip_kind,
    derive_generalized,
    fill_generalized,
    {"hyst/generalized_maxwell_slip.h",
     "$signal = hyst_generalized_maxwell_slip_step(&$model, $memory, $signal);"},
    nullptr,
    nullptr,
    nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
