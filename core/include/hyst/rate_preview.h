/* Inverse of a rate-dependent Prandtl-Ishlinskii operator that knows the next samples of the reference:
 * the output at k is the command for sample k - preview.
 *
 * A plan of the next preview + 1 commands is carried on from sample to sample. With every sample it is
 * shifted, lengthened as the explicit inverse (S4 eqs. 12-16) moves, and improved by one damped
 * Gauss-Newton step on the squared error of the simulated output, a small penalty on second differences
 * of the plan, and the distance of its last command from that of the explicit inverse; corners of the
 * plays and of |u_k - u_{k-1}| are rounded meanwhile. What is met with u_k now and u_{k-1} before is
 * followed exactly through the plays, whose memory is carried to the sample where it is picked up. Beside
 * the plan a second one, begun anew from the explicit inverse every HYST_PREVIEW_LIFE samples, is
 * improved, from smooth to sharp, and takes its place if it costs less by then.
 *
 * A step costs no more than two such steps and four simulations of the plan: of the order of
 * (preview + 1)^3 / 3 and preview * count operations. Nothing depends on samples before those in the
 * window but through the memory of the plays, which is that of the model driven by the commands given.
 *
 * Before there are preview + 1 samples the command is the one that holds the first of them.
 *
 * State: the model's, the explicit inverse's, then as the offsets say. */
#ifndef HYST_RATE_PREVIEW_H
#define HYST_RATE_PREVIEW_H

#include "hyst/kind.h"
#include "hyst/rate_dependent_prandtl_ishlinskii.h"
#include "hyst/real.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

typedef struct {
    hyst_rate_dependent_pi plays; /* the model, p0 > 0 */
    hyst_rate_dependent_pi guess; /* its explicit inverse */
    size_t preview;               /* samples known beyond the present one */
    int ranged;                   /* whether low <= command <= high */
    hyst_real low;
    hyst_real high;
    int slowed;                   /* whether |command_k - command_{k-1}| <= change */
    hyst_real change;
} hyst_rate_preview;

/* How the state is divided; every part is given by where it begins. */
typedef struct {
    size_t guess;   /* memory of the explicit inverse */
    size_t scalars; /* HYST_PREVIEW_SCALARS of them */
    size_t target;  /* the samples known, the oldest first, preview + 1 of each from here on */
    size_t start;   /* commands of the explicit inverse */
    size_t plan;
    size_t rival;
    size_t scratch; /* zero between steps */
    size_t end;
} hyst_preview_places;

#define HYST_PREVIEW_SCALARS 5u
#define HYST_PREVIEW_KNOWN 0u   /* samples in the window */
#define HYST_PREVIEW_BEGUN 1u   /* not 0: the first command is that of the first sample, none before */
#define HYST_PREVIEW_AGE 2u     /* steps of the rival */
#define HYST_PREVIEW_DAMPING 3u /* of the plan, then of the rival, over the squared gain */

#define HYST_PREVIEW_LIFE 5u

/* How smooth a problem is, in its units; gain is p0 + sum |p|. */
typedef struct {
    hyst_real roughness; /* weight of squared second differences */
    hyst_real rate;      /* corners are rounded over this change of the command in a sample */
    hyst_real contact;   /* and this distance from contact */
    hyst_real gain;
} hyst_preview_stage;

hyst_preview_places hyst_preview_layout(const hyst_rate_preview *model);

/* Improves a plan of `length` commands once, in place; returns its cost. */
hyst_real hyst_preview_improve(const hyst_rate_preview *model, const hyst_preview_places *at,
                               hyst_real *state, size_t length, const hyst_preview_stage *stage,
                               hyst_real *plan, hyst_real *damping);

/* One sample. What is not finite, or would make a plan so, is answered by NaN and the state kept. */
hyst_real hyst_rate_preview_step(const hyst_rate_preview *model, hyst_real *state, hyst_real y);

extern const hyst_kind hyst_rate_preview_kind; /* of a hyst_rate_preview */

#ifdef HYST_EXTERN_C
}
#endif

#endif
