/* Inverses that solve for the input of every sample. */
#include "hyst/solved.h"

#include "hyst/finite.h"
#include "hyst/play.h"

/* The piece of f that holds `at`: f = slope u + constant from `below` to `above`, where it has ends. */
typedef struct {
    hyst_real slope;
    hyst_real constant;
    hyst_real below;
    hyst_real above;
    int has_below;
    int has_above;
} solved_piece;

/* Where the search is, and the ends of pieces between which the solution is known to lie. */
typedef struct {
    hyst_real at;
    hyst_real low;
    hyst_real high;
    int has_low;
    int has_high;
    int upwards; /* whether an end of a piece counts to the piece above it */
} solved_search;

static solved_piece solved_begin(hyst_real slope)
{
    solved_piece piece;
    piece.slope = slope;
    piece.constant = HYST_REAL(0.0);
    piece.below = HYST_REAL(0.0);
    piece.above = HYST_REAL(0.0);
    piece.has_below = 0;
    piece.has_above = 0;
    return piece;
}

/* Takes an end of pieces into account; gives 1 where the search is above it. */
static int solved_passed(const solved_search *search, solved_piece *piece, hyst_real end)
{
    const int passed = end < search->at || (search->upwards != 0 && !(end > search->at));
    if (passed != 0) {
        if (piece->has_below == 0 || end > piece->below) {
            piece->below = end;
        }
        piece->has_below = 1;
    } else {
        if (piece->has_above == 0 || end < piece->above) {
            piece->above = end;
        }
        piece->has_above = 1;
    }
    return passed;
}

/* Gives 1 where `at` is the solution, else `at` lies in another piece that may hold it. */
static int solved_next(solved_search *search, const solved_piece *piece, hyst_real y)
{
    const hyst_real u = (y - piece->constant) / piece->slope;
    if (piece->has_above != 0 && u > piece->above) {
        search->low = piece->above;
        search->has_low = 1;
        search->upwards = 1;
        search->at = u;
        if (search->has_high != 0 && u >= search->high) {
            search->at = piece->above;
        }
    } else if (piece->has_below != 0 && u < piece->below) {
        search->high = piece->below;
        search->has_high = 1;
        search->upwards = 0;
        search->at = u;
        if (search->has_low != 0 && u <= search->low) {
            search->at = piece->below;
        }
    } else {
        search->at = u;
        return 1;
    }
    /* Rounding may see the solution on either side of the end it lies on. */
    if (search->has_low != 0 && search->has_high != 0 && search->low >= search->high) {
        search->at = search->low;
        return 1;
    }
    return 0;
}

static solved_search solved_from(hyst_real at)
{
    solved_search search;
    search.at = at;
    search.low = at;
    search.high = at;
    search.has_low = 0;
    search.has_high = 0;
    search.upwards = 1;
    return search;
}

static solved_piece piece_of_plays(const hyst_pi *pi, const hyst_real *z, const solved_search *search)
{
    solved_piece piece = solved_begin(pi->p0);
    for (size_t i = 0; i < pi->count; ++i) {
        const hyst_real p = pi->p[i];
        const hyst_real r = pi->r[i];
        const int is_above = solved_passed(search, &piece, z[i] + r);
        const int is_within = solved_passed(search, &piece, z[i] - r);
        if (is_above != 0) {
            piece.slope += p;
            piece.constant -= p * r;
        } else if (is_within == 0) {
            piece.slope += p;
            piece.constant += p * r;
        } else {
            piece.constant += p * z[i];
        }
    }
    return piece;
}

hyst_real hyst_pi_solved_step(const hyst_pi *pi, hyst_real *z, hyst_real y)
{
    /* The narrowest play is nearest to the input before. */
    solved_search search = solved_from(pi->count > 0u ? z[0] : HYST_REAL(0.0));
    solved_piece piece = piece_of_plays(pi, z, &search);
    while (solved_next(&search, &piece, y) == 0) {
        piece = piece_of_plays(pi, z, &search);
    }
    if (hyst_is_finite(search.at) != 0) {
        for (size_t i = 0; i < pi->count; ++i) {
            z[i] = hyst_play(search.at, pi->r[i], z[i]);
        }
    }
    return search.at;
}

static solved_piece piece_of_map(const hyst_dead_zone *map, const solved_search *search)
{
    const hyst_real zero = HYST_REAL(0.0);
    solved_piece piece = solved_begin(zero);
    for (size_t i = 0; i < map->count; ++i) {
        const hyst_real weight = map->weight[i];
        const hyst_real rho = map->threshold[i];
        int acts = 1;
        if (rho > zero || rho < zero) {
            const int passed = solved_passed(search, &piece, rho);
            if (rho > zero ? passed == 0 : passed != 0) {
                acts = 0;
            }
        }
        if (acts != 0) {
            piece.slope += weight;
            piece.constant -= weight * rho;
        }
    }
    return piece;
}

hyst_real hyst_dead_zone_solved_step(const hyst_dead_zone *map, hyst_real y)
{
    solved_search search = solved_from(HYST_REAL(0.0));
    solved_piece piece = piece_of_map(map, &search);
    while (solved_next(&search, &piece, y) == 0) {
        piece = piece_of_map(map, &search);
    }
    return search.at;
}

hyst_real hyst_affine_solved_step(const hyst_affine *map, hyst_real y)
{
    return (y - map->offset) / map->gain;
}

static size_t pi_solved_length(const void *model)
{
    return ((const hyst_pi *)model)->count;
}

static hyst_real pi_solved_step(const void *model, hyst_real *state, hyst_real y)
{
    return hyst_pi_solved_step((const hyst_pi *)model, state, y);
}

const hyst_kind hyst_pi_solved_kind = {pi_solved_length, pi_solved_step};

static size_t solved_map_length(const void *model)
{
    (void)model;
    return 0;
}

static hyst_real dead_zone_solved_step(const void *model, hyst_real *state, hyst_real y)
{
    (void)state;
    return hyst_dead_zone_solved_step((const hyst_dead_zone *)model, y);
}

const hyst_kind hyst_dead_zone_solved_kind = {solved_map_length, dead_zone_solved_step};

static hyst_real affine_solved_step(const void *model, hyst_real *state, hyst_real y)
{
    (void)state;
    return hyst_affine_solved_step((const hyst_affine *)model, y);
}

const hyst_kind hyst_affine_solved_kind = {solved_map_length, affine_solved_step};
