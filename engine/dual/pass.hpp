// A record through one stage of the core with tangents.
#pragma once

#include "core.hpp"
#include "derivative.hpp"

namespace hyst {
namespace HYST_KINDS {

static const hyst_kind *const core_kinds[] = {HYST_ALL_KINDS};

// The first `count` tangents of `from`; the others stay as they are. All of them, and none, go
// without a detour.
static inline void load(Tangent &to, const double *from, size_t count)
{
    if (count == HYST_TANGENTS) {
        __builtin_memcpy(&to, from, sizeof to);
    } else if (count > 0) {
        double part[HYST_TANGENTS] = {};
        for (size_t c = 0; c < count; ++c) part[c] = from[c];
        __builtin_memcpy(&to, part, sizeof to);
    }
}

static inline void store(double *to, const Tangent &from, size_t count)
{
    if (count == HYST_TANGENTS) {
        __builtin_memcpy(to, &from, sizeof from);
    } else {
        double part[HYST_TANGENTS];
        __builtin_memcpy(part, &from, sizeof from);
        for (size_t c = 0; c < count; ++c) to[c] = part[c];
    }
}

static inline void pass(size_t kind, const void *model, void *state, const Columns &at)
{
    const size_t known = at.incoming > at.first ? at.incoming - at.first : 0;
    const size_t given = known < at.count ? known : at.count;
    hyst_real (*const step)(const void *, hyst_real *, hyst_real) = core_kinds[kind]->step;
    for (size_t k = 0; k < at.samples; ++k) {
        double *row = at.rows + k * at.stride + at.first;
        hyst_real u(at.u[k]);
        load(u.d, row, given);
        const hyst_real y = step(model, static_cast<hyst_real *>(state), u);
        store(row, y.d, at.count);
        at.y[k] = y.v;
    }
}

}  // namespace HYST_KINDS
}  // namespace hyst
