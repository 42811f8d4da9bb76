/* Affine map without memory:  y = gain u + offset. */
#ifndef HYST_AFFINE_H
#define HYST_AFFINE_H

#include "hyst/kind.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    hyst_real gain;
    hyst_real offset;
} hyst_affine;

hyst_real hyst_affine_step(const hyst_affine *map, hyst_real u);

extern const hyst_kind hyst_affine_kind; /* of a hyst_affine */

#ifdef HYST_EXTERN_C
}
#endif

#endif
