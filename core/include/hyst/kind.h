/* What a chain asks of a kind of stage: one row, which stands beside the kind's step.
 * `model` is the kind's structure of constants, as hyst_pi. */
#ifndef HYST_KIND_H
#define HYST_KIND_H

#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    size_t (*length)(const void *model); /* number of state values */
    hyst_real (*step)(const void *model, hyst_real *state, hyst_real u);
} hyst_kind;

#ifdef HYST_EXTERN_C
}
#endif

#endif
