// Linear dynamics: a state space, and sections of second order.
#include "fast/linear.hpp"
#include "hyst/linear_dynamics.h"
#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

// A row after row, B, C, D; the core takes A column after column.
void derive_state_space(const Given &given, Constants &made) {
    const std::size_t n = given.choices.at("order"), delay = given.choices.at("delay");
    given.require(n <= HYST_LARGEST_ORDER && given.constants.size() == (n + 2) * n + 1);
    Reals a(n * n);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) a[j * n + i] = given.constants[i * n + j];
    }
    const hyst_real d = given.constants.back();
    made.feeds_through = delay == 0 && d != 0.0;
    // Feedthrough cannot be switched on: the dependencies of the output would no longer be true.
    made.number("d", d, {made.feeds_through ? Offer::tunable : Offer::constant, "feedthrough"});
    made.table("a", std::move(a), not_offered);
    made.table("b", given.part(n * n, n), not_offered);
    made.table("c", given.part((n + 1) * n, n), {Offer::tunable, "output vector"});
    made.choose("delay", delay);
    made.structure = "hyst_state_space $model = {#b, #delay, $a, $b, $c, $d};";
}

const void *fill_state_space(Constants &of) {
    return of.hold(hyst_state_space{of.size("b"), of.choice("delay"), of.table("a"), of.table("b"),
                                    of.table("c"), of.number("d")});
}

// b0 b1 b2 a1 a2 of each section.
void derive_sections(const Given &given, Constants &made) {
    const std::size_t count = given.constants.size() / 5;
    given.require(given.constants.size() == 5 * count);
    for (std::size_t i = 0; i < count; ++i) {
        made.feeds_through = made.feeds_through && given.constants[5 * i] != 0.0;
    }
    made.table("coefficient", given.constants, not_offered);
    made.structure = "hyst_sections $model = {#coefficient/5, $coefficient};";
}

const void *fill_sections(Constants &of) {
    return of.hold(hyst_sections{of.size("coefficient") / 5, of.table("coefficient")});
}

}  // namespace

extern const Kind state_space, sections;

const Kind state_space = {
    "state_space",
    &hyst_state_space_kind,
    derive_state_space,
    fill_state_space,
    {"hyst/linear_dynamics.h", "$signal = hyst_state_space_step(&$model, $memory, $signal);"},
    HYST_IN_DOUBLE(state_space_jacobian),
    HYST_IN_DOUBLE(run_state_space),
    nullptr};

const Kind sections = {
    "sections",
    &hyst_sections_kind,
    derive_sections,
    fill_sections,
    {"hyst/linear_dynamics.h", "$signal = hyst_sections_step(&$model, $memory, $signal);"},
    HYST_IN_DOUBLE(sections_jacobian),
    nullptr,
    nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
