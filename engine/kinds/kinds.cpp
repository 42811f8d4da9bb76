// All kinds of stages, a line each.
#include "kind.hpp"

#define EACH_KIND(ROW)              \
    ROW(affine)                     \
    ROW(affine_solved)              \
    ROW(bouc_wen)                   \
    ROW(coleman_hodgdon)            \
    ROW(creep)                      \
    ROW(creeping_plays)             \
    ROW(dahl)                       \
    ROW(dead_zone)                  \
    ROW(dead_zone_solved)           \
    ROW(degrading_bouc_wen)         \
    ROW(delay)                      \
    ROW(delay_preview)              \
    ROW(direction_dead_zone)        \
    ROW(generalized_maxwell_slip)   \
    ROW(jiles_atherton)             \
    ROW(lag)                        \
    ROW(lugre)                      \
    ROW(masing)                     \
    ROW(maxwell_slip)               \
    ROW(memory_element)             \
    ROW(pi)                         \
    ROW(pi_solved)                  \
    ROW(play)                       \
    ROW(preisach)                   \
    ROW(rate_dependent_pi)          \
    ROW(rate_preview)               \
    ROW(rate_shift)                 \
    ROW(sections)                   \
    ROW(state_map)                  \
    ROW(state_space)                \
    ROW(stop)                       \
    ROW(two_envelope)

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

const Kind &known_kind(const std::string &name) {
    const Kind *kind = kind_named(name);
    if (kind == nullptr) throw std::invalid_argument("unknown kind of stage '" + name + "'");
    return *kind;
}

const void *build(const Kind &kind, const Given &given, Constants &made) {
    kind.derive(given, made);
    return kind.fill(made);
}

}  // namespace HYST_KINDS
}  // namespace hyst
