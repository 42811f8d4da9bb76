/* Stages inside a stage: their output and the input itself, mapped together onto the output.
 *
 *     z = (stage_n o .. o stage_1)[u],   y = sum over i + j <= n of c_ij u^i z^j
 *
 * The state is that of the stages inside, one after the other. */
#ifndef HYST_STATE_MAP_H
#define HYST_STATE_MAP_H

#include "hyst/chain.h"
#include "hyst/kind.h"
#include "hyst/real.h"
#include "hyst/state_polynomial.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    hyst_chain inside; /* which makes z of u */
    hyst_state_polynomial map;
} hyst_state_map;

extern const hyst_kind hyst_state_map_kind; /* of a hyst_state_map */

#ifdef HYST_EXTERN_C
}
#endif

#endif
