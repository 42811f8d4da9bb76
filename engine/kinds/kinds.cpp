// All kinds of stages, a line each.
#include "kind.hpp"

#define EACH_KIND(ROW)       \
    ROW(affine)              \
    ROW(coleman_hodgdon)     \
    ROW(dahl)                \
    ROW(dead_zone)           \
    ROW(direction_dead_zone) \
    ROW(jiles_atherton)      \
    ROW(masing)              \
    ROW(memory_element)      \
    ROW(pi)                  \
    ROW(play)                \
    ROW(rate_dependent_pi)   \
    ROW(sections)            \
    ROW(state_space)         \
    ROW(stop)

namespace hyst {
namespace HYST_KINDS {

#define DECLARE(name) extern const Kind name;
EACH_KIND(DECLARE)

std::vector<const Kind *> all_kinds() {
#define ADDRESS(name) &name,
    return {EACH_KIND(ADDRESS)};
}

const Kind *kind_named(const std::string &name) {
    for (const Kind *each : all_kinds()) {
        if (name == each->name) return each;
    }
    return nullptr;
}

const void *build(const Kind &kind, const Given &given, Constants &made) {
    kind.derive(given, made);
    return kind.fill(made);
}

}  // namespace HYST_KINDS
}  // namespace hyst
