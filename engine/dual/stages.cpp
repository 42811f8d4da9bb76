// Compiled once for every number of tangents: the rows of the kinds, which turn an operator's
// constants into the core's, so that these carry their derivatives too; and the baseline's pass.
#include "pass.hpp"

#define HYST_OTHER_NUMBER
#include "kinds.inc"  // made by CMakeLists.txt: the files of engine/kinds

#include "given.hpp"

namespace hyst {
namespace HYST_KINDS {

extern const Pass run_pass;

const Pass run_pass = pass;

// Runs columns `at` of the Jacobian of the stage that is said, from the memory `start`.
void run_columns(const Said &said, const Remembered &memory, const double *start, const Columns &at,
                 Pass run) {
    Given given = given_of(said);
    for (std::size_t c = 0; c < at.count; ++c) {
        if (at.first + c < at.incoming) continue;
        hyst_real &constant = given.constants[at.first + c - at.incoming];
        reinterpret_cast<double *>(&constant.d)[c] = 1.0;
    }
    Constants made;
    const Kind &kind = *kind_named(said.kind);
    const void *model = build(kind, given, made);
    const std::size_t length = kind.core->length(model);
    std::vector<hyst_real> state(start, start + length);
    const auto own = [&](std::size_t i) { return memory.tangents + i * memory.stride + at.first; };
    for (std::size_t i = 0; memory.tangents != nullptr && i < length; ++i) {
        load(state[i].d, own(i), at.count);
    }
    std::size_t place = 0;
    while (core_kinds[place] != kind.core) ++place;
    run(place, model, state.data(), at);
    for (std::size_t i = 0; memory.tangents != nullptr && i < length; ++i) {
        store(own(i), state[i].d, at.count);
        memory.state[i] = state[i].v;
    }
}

}  // namespace HYST_KINDS
}  // namespace hyst
