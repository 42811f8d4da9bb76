// A kind of stage is a row: what the core, the whole records, the derivatives and the exports need of it.
// engine/kinds/kinds.cpp lists the rows; each stands in the file of its kind.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "constants.hpp"
#include "cotangents.hpp"
#include "hyst/kind.h"
#include "hyst/prandtl_ishlinskii.h"
#include "tangents.hpp"

// Own derivatives and fast runs are for doubles; a build in another number type has none of them.
#if defined(HYST_SINGLE) || defined(HYST_OTHER_NUMBER)
#define HYST_IN_DOUBLE(column) nullptr
#else
#define HYST_IN_DOUBLE(column) column
#endif

namespace hyst {
namespace HYST_KINDS {

// How an export calls the kind: the header it includes and the call of one sample. $signal is the
// input and afterwards the output, $memory points to the state, $model is the structure, $name a
// constant, $form the enumerator of the form, $input what the signal was before the stages inside. Constants::structure says how the structure is made, with
// #name for the entries of a table, or for a choice that is a size. What starts with "TYPE $model = {"
// can stand at the head of a file; anything else is statements.
struct Written {
    const char *header, *call;
};

// What time lanes ask of a kind made of plays. `packed` holds the states of as many lanes as the kernels
// are wide, value after value, lane beside lane.
struct Plays {
    bool (*can_take)(const void *model);  // thresholds that ascend from zero or more
    std::size_t (*count)(const void *model);
    void (*jump)(const void *model, double *state, const double *u, std::size_t samples);
    bool (*run)(const void *model, double *packed, const double *u, double *y, std::size_t samples,
                std::size_t stride);
    const hyst_pi *(*bank)(const void *model);  // what the memory curve can take; or null
};

struct Kind {
    const char *name;
    const hyst_kind *core;
    // From the operator's constants to the core's, and from those to the core's structure.
    void (*derive)(const Given &given, Constants &made);
    const void *(*fill)(Constants &of);
    Written written;
    // Columns a kind need not have. The own derivative, with one column a parameter:
    void (*jacobian)(const void *model, double dt, const double *state, const Tangents &tangents);
    // the core's loop with the core's bits, faster; u and y may be the same:
    void (*run)(const void *model, double *state, const double *u, double *y, std::size_t samples);
    const Plays *plays;
    // the own derivative from the output back to input and constants:
    void (*reverse)(const void *model, const Cotangents &given) = nullptr;
};

// A stage inside another one.
struct Inside {
    const Kind *kind;
    Constants constants;
};

// All rows; the row of a name or null; and the row of a name, or a refusal.
std::vector<const Kind *> all_kinds();
const Kind *kind_named(const std::string &name);
const Kind &known_kind(const std::string &name);

// Derives and fills; what the model is made of stays in `made`.
const void *build(const Kind &kind, const Given &given, Constants &made);

}  // namespace HYST_KINDS
}  // namespace hyst
