// A loading curve with memory of reversals.
#include "hyst/masing.h"

#include "fast/masing.hpp"
#include "hyst/power.h"
#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

#define MEMORY_OF_REVERSALS                                                              \
    " $model.inverse = $inverse; $model.last_reversal = $last_reversal; $model.depth = " \
    "#depth; $model.dead_band = $dead_band;"

// c1 c2 c3: f(x) = c1 x + 2^c3 c2 / (c3 + 1) x^(c3 + 1).
void derive_power_law(const Given &given, Constants &made) {
    given.require(given.constants.size() == 3);
    const hyst_real c2 = given.constants[1], c3 = given.constants[2];
    const hyst_real exponent = c3 + HYST_REAL(1.0);
    made.form = "HYST_POWER_LAW";
    made.number("linear", given.constants[0], not_offered);
    made.number("factor", hyst_power(HYST_REAL(2.0), c3) * c2 / exponent, not_offered);
    made.number("exponent", exponent, not_offered);
    made.structure =
        "hyst_masing $model; $model.curve.kind = $form; $model.curve.as.power_law.linear = $linear; "
        "$model.curve.as.power_law.factor = $factor; "
        "$model.curve.as.power_law.exponent = $exponent;" MEMORY_OF_REVERSALS;
}

// p0 p r: knots, values and slopes of f(x) = p0 x + sum_i p_i max(x - r_i, 0).
void derive_pieces(const Given &given, Constants &made) {
    const std::size_t plays = given.constants.size() / 2;
    given.require(given.constants.size() == 1 + 2 * plays);
    Reals knot{HYST_REAL(0.0)}, value{HYST_REAL(0.0)}, slope{given.constants[0]};
    for (std::size_t i = 0; i < plays; ++i) {
        const hyst_real p = given.constants[1 + i], r = given.constants[1 + plays + i];
        value.push_back(value.back() + slope.back() * (r - knot.back()));
        knot.push_back(r);
        slope.push_back(slope.back() + p);
    }
    made.form = "HYST_PLAYS";
    made.table("knot", std::move(knot), not_offered);
    made.table("value", std::move(value), not_offered);
    made.table("slope", std::move(slope), not_offered);
    made.structure =
        "hyst_masing $model; $model.curve.kind = $form; $model.curve.as.pieces.count = #knot; "
        "$model.curve.as.pieces.knot = $knot; $model.curve.as.pieces.value = $value; "
        "$model.curve.as.pieces.slope = $slope;" MEMORY_OF_REVERSALS;
}

// a_1 .. a_n, and a bound of the slope.
void derive_polynomial(const Given &given, Constants &made) {
    made.form = "HYST_POLYNOMIAL";
    made.number("least_slope", given.kept("least_slope").at(0), not_offered);
    made.table("coefficient", given.constants, not_offered);
    made.structure =
        "hyst_masing $model; $model.curve.kind = $form; "
        "$model.curve.as.polynomial.count = #coefficient; "
        "$model.curve.as.polynomial.coefficient = $coefficient; "
        "$model.curve.as.polynomial.least_slope = $least_slope;" MEMORY_OF_REVERSALS;
}

// c d b: f(x) = c x - d b (1 - exp(-x / b)).
void derive_exponential(const Given &given, Constants &made) {
    given.require(given.constants.size() == 3);
    const hyst_real c = given.constants[0], d = given.constants[1];
    made.form = "HYST_EXPONENTIAL";
    made.number("first", c - d, not_offered);
    made.number("last", c, not_offered);
    made.number("change", d, not_offered);
    made.number("way", given.constants[2], not_offered);
    made.structure =
        "hyst_masing $model; $model.curve.kind = $form; "
        "$model.curve.as.exponential.first = $first; $model.curve.as.exponential.last = $last; "
        "$model.curve.as.exponential.change = $change; "
        "$model.curve.as.exponential.way = $way;" MEMORY_OF_REVERSALS;
}

// F_S K_T chi beta K_inf. With K = K_T / (1 + beta) the stiffness of what is spread:
// limit = F_S / (K (beta + (chi + 1) / (chi + 2))), q = K / ((chi + 2) limit^(chi + 1)).
void derive_iwan(const Given &given, Constants &made) {
    given.require(given.constants.size() == 5);
    const hyst_real force = given.constants[0], total = given.constants[1];
    const hyst_real chi = given.constants[2], beta = given.constants[3];
    const hyst_real residual = given.constants[4], one = HYST_REAL(1.0);
    const hyst_real exponent = chi + HYST_REAL(2.0);
    const hyst_real spread = total / (one + beta);
    const hyst_real limit = force / (spread * (beta + (chi + one) / exponent));
    made.form = "HYST_IWAN";
    made.number("stiffness", total + residual, not_offered);
    made.number("factor", spread / (exponent * hyst_power(limit, chi + one)), not_offered);
    made.number("exponent", exponent, not_offered);
    made.number("limit", limit, not_offered);
    made.number("force", force, not_offered);
    made.number("residual", residual, not_offered);
    made.structure =
        "hyst_masing $model; $model.curve.kind = $form; "
        "$model.curve.as.iwan.stiffness = $stiffness; $model.curve.as.iwan.factor = $factor; "
        "$model.curve.as.iwan.exponent = $exponent; $model.curve.as.iwan.limit = $limit; "
        "$model.curve.as.iwan.force = $force; "
        "$model.curve.as.iwan.residual = $residual;" MEMORY_OF_REVERSALS;
}

void derive_masing(const Given &given, Constants &made) {
    made.number("dead_band", given.kept("dead_band").at(0), not_offered);
    if (given.form == "power-law") {
        derive_power_law(given, made);
    } else if (given.form == "plays") {
        derive_pieces(given, made);
    } else if (given.form == "polynomial") {
        derive_polynomial(given, made);
    } else if (given.form == "exponential") {
        derive_exponential(given, made);
    } else if (given.form == "iwan") {
        derive_iwan(given, made);
    } else {
        throw std::invalid_argument("unknown loading curve '" + given.form + "'");
    }
    for (const char *each : {"inverse", "last_reversal", "depth"}) {
        made.choose(each, given.choices.at(each));
    }
}

hyst_loading_curve curve_of(const Constants &of) {
    hyst_loading_curve made{};
    if (of.form == "HYST_POWER_LAW") {
        made.kind = HYST_POWER_LAW;
        made.as.power_law = {of.number("linear"), of.number("factor"), of.number("exponent")};
    } else if (of.form == "HYST_PLAYS") {
        made.kind = HYST_PLAYS;
        made.as.pieces = {of.size("knot"), of.table("knot"), of.table("value"), of.table("slope")};
    } else if (of.form == "HYST_EXPONENTIAL") {
        made.kind = HYST_EXPONENTIAL;
        made.as.exponential = {of.number("first"), of.number("last"), of.number("change"),
                               of.number("way")};
    } else if (of.form == "HYST_IWAN") {
        made.kind = HYST_IWAN;
        made.as.iwan = {of.number("stiffness"), of.number("factor"), of.number("exponent"),
                        of.number("limit"),     of.number("force"),  of.number("residual")};
    } else {
        made.kind = HYST_POLYNOMIAL;
        made.as.polynomial = {of.size("coefficient"), of.table("coefficient"),
                              of.number("least_slope")};
    }
    return made;
}

const void *fill_masing(Constants &of) {
    return of.hold(hyst_masing{curve_of(of), of.is("inverse"), of.is("last_reversal"),
                               of.choice("depth"), of.number("dead_band")});
}

}  // namespace

extern const Kind masing;

const Kind masing = {"masing",
                     &hyst_masing_kind,
                     derive_masing,
                     fill_masing,
                     {"hyst/masing.h", "$signal = hyst_masing_step(&$model, $memory, $signal);"},
                     nullptr,
                     HYST_IN_DOUBLE(run_masing),
                     nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
