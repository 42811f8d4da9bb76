/* Parts of joint_estimator.h and joint_search.h that are tested by themselves. */
#ifndef HYST_JOINT_PARTS_H
#define HYST_JOINT_PARTS_H

#include "hyst/joint_estimator.h"
#include "hyst/joint_search.h"

#ifdef HYST_EXTERN_C
extern "C" {
#endif

/* S(x, rho) of dead_zone.h; a map and its slope at x. Without terms it is the identity. */
hyst_real hyst_joint_term(hyst_real x, hyst_real rho);
hyst_real hyst_joint_map_at(const hyst_joint_map *map, const hyst_real *weight, hyst_real x);
hyst_real hyst_joint_map_slope(const hyst_joint_map *map, const hyst_real *weight, hyst_real x);

/* Follows the input: where each play left its envelope, which one, and how far it has come. */
void hyst_joint_follow(const hyst_joint *joint, const hyst_joint_layout *at, hyst_real *state,
                       hyst_real u);

/* Fills the gradient psi and returns the predicted output. variance: of the parameters; *doubt: the
 * variance of what the linear model of y leaves unexplained. */
hyst_real hyst_joint_predict(const hyst_joint *joint, const hyst_joint_layout *at,
                             hyst_real *state, hyst_real u, const hyst_real *variance,
                             hyst_real *doubt);

/* The memory that goes with the parameters, one that an input could have left. */
void hyst_joint_set_memory(const hyst_joint *joint, const hyst_joint_layout *at, hyst_real *state,
                           hyst_real u);

/* Takes theta, which its factors d and u follow in memory, towards the models that can be inverted,
 * in the metric of its covariance. a, product: scratch of length m. */
void hyst_joint_project(const hyst_joint *joint, const hyst_joint_layout *at, hyst_real *theta,
                        hyst_real *a, hyst_real *product);

/* Takes theta among the models that can be inverted, parameter by parameter. */
void hyst_joint_clamp(const hyst_joint *joint, hyst_real *theta);

/* The variance of the noise after one more sample, the squared error of which is `surprise` times
 * its variance; seen: how many came before. */
hyst_real hyst_joint_noise(const hyst_joint *joint, hyst_real noise, hyst_real seen,
                           hyst_real surprise);

/* The cells of a search: many plays of fixed radii, and their weights by recursive least squares. */
void hyst_cells_start(const hyst_search *search, const hyst_search_layout *at, hyst_real *state);
void hyst_cells_follow(const hyst_search *search, const hyst_search_layout *at, hyst_real *state,
                       hyst_real v);
void hyst_cells_measure(const hyst_search *search, const hyst_search_layout *at, hyst_real *state,
                        hyst_real v, hyst_real y);
/* Forgets what HYST_SEARCH_GROWTH says, never beyond the variances of the start. */
void hyst_cells_forget(const hyst_search *search, const hyst_search_layout *at, hyst_real *state);
/* Begins to merge, and makes one of those two neighbours whose union loses least. */
void hyst_cells_begin_merging(const hyst_search *search, const hyst_search_layout *at,
                              hyst_real *state);
void hyst_cells_merge(const hyst_search_layout *at, hyst_real *state);

#ifdef HYST_EXTERN_C
}
#endif

#endif
