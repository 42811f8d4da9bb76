// A delay by parts of a sample and its inverses: at once, and by preview.
#include "hyst/delay.h"
#include "hyst/delay_preview.h"

#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

// Samples by which it is late; how many of them are whole is a choice, so that the memory keeps its
// length while a fit moves the fraction.
void derive_delay(const Given &given, Constants &made) {
    given.require(given.constants.size() == 1);
    const std::size_t whole = given.choices.at("whole");
    const hyst_real fraction = given.constants[0] - hyst_real(static_cast<double>(whole));
    made.feeds_through = whole == 0;
    made.number("fraction", fraction, not_offered);
    const std::size_t inverse = given.choices.at("inverse");
    const hyst_real lead = fraction / (hyst_real(1.0) - fraction);
    made.number("lead", inverse != 0 ? lead : hyst_real(0.0), not_offered);
    made.choose("whole", whole);
    made.choose("inverse", inverse);
    made.structure = "hyst_delay $model = {#whole, $fraction, $lead, $inverse};";
}

const void *fill_delay(Constants &of) {
    return of.hold(hyst_delay{of.choice("whole"), of.number("fraction"), of.number("lead"),
                              of.is("inverse")});
}

// No parameters: the fraction is kept, and how many samples are known ahead is a choice.
void derive_delay_preview(const Given &given, Constants &made) {
    given.require(given.constants.empty());
    const hyst_real fraction = given.kept("fraction").at(0);
    made.number("lead", (hyst_real(1.0) - fraction) / fraction, not_offered);
    made.choose("ahead", given.choices.at("ahead"));
    made.structure = "hyst_delay_preview $model = {#ahead, $lead};";
}

const void *fill_delay_preview(Constants &of) {
    return of.hold(hyst_delay_preview{of.choice("ahead"), of.number("lead")});
}

}  // namespace

extern const Kind delay, delay_preview;

const Kind delay = {"delay",
                    &hyst_delay_kind,
                    derive_delay,
                    fill_delay,
                    {"hyst/delay.h", "$signal = hyst_delay_step(&$model, $memory, $signal);"},
                    nullptr,
                    nullptr,
                    nullptr};

const Kind delay_preview = {
    "delay_preview",
    &hyst_delay_preview_kind,
    derive_delay_preview,
    fill_delay_preview,
    {"hyst/delay_preview.h", "$signal = hyst_delay_preview_step(&$model, $memory, $signal);"},
    nullptr,
    nullptr,
    nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
