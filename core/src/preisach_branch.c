/* Branches of the Preisach operator, piece by piece.
 *
 * Invariant: what rounding leaves of a branch still rises with its way, since every sum here adds terms
 * that do: the entries of the table, the shares of the first cell and the linear part. */
#include "hyst/preisach.h"

typedef struct {
    hyst_preisach_point start;
    int rising;
    /* The cell it starts in, how much of that lies ahead and behind, 1 in all, and what the square
     * of an even mass in the triangle takes off the straight line. */
    size_t cell;
    hyst_real ahead, behind, bend;
    hyst_real entry; /* where it meets the grid */
} preisach_branch;

static hyst_real preisach_size(hyst_real value)
{
    return value < HYST_REAL(0.0) ? -value : value;
}

/* The last of `count` cells that begins at or below x, by halving. */
static size_t preisach_halving(const hyst_real *edge, size_t count, size_t stride, hyst_real x)
{
    size_t low = 0, high = count;
    while (high - low > 1u) {
        const size_t middle = low + (high - low) / 2u;
        if (edge[middle * stride] <= x) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/* The cell with t_i <= u < t_i+1; the first or the last for what is below or above. */
static size_t preisach_cell_above(const hyst_preisach *model, hyst_real u)
{
    const hyst_real *t = model->threshold;
    const hyst_real place = (u - t[0]) * model->per_input;
    const size_t last = model->cells - 1u;
    size_t i = last;
    if (!(place >= (hyst_real)last)) {
        i = place > HYST_REAL(0.0) ? (size_t)place : 0u;
    }
    if ((i == 0u || t[i] <= u) && (i == last || u < t[i + 1u])) {
        return i;
    }
    return preisach_halving(t, model->cells, 1u, u);
}

/* The cell with t_i < u <= t_i+1. */
static size_t preisach_cell_below(const hyst_preisach *model, hyst_real u)
{
    const size_t i = preisach_cell_above(model, u);
    return i > 0u && u <= model->threshold[i] ? i - 1u : i;
}

static hyst_real preisach_entry(const hyst_preisach *model, size_t alpha, size_t beta)
{
    return model->everett[alpha * (alpha + 1u) / 2u + beta];
}

/* Twice the mass between threshold k and the far, or the near, edge of the cell a branch starts in. */
static hyst_real preisach_far(const hyst_preisach *model, const preisach_branch *branch, size_t k)
{
    return branch->rising ? preisach_entry(model, k, branch->cell)
                          : preisach_entry(model, branch->cell + 1u, k);
}

static hyst_real preisach_near(const hyst_preisach *model, const preisach_branch *branch, size_t k)
{
    return branch->rising ? preisach_entry(model, k, branch->cell + 1u)
                          : preisach_entry(model, branch->cell, k);
}

/* What the relays move the output by on the way to threshold k, beyond the first cell's start. */
static hyst_real preisach_way(const hyst_preisach *model, const preisach_branch *branch, size_t k)
{
    const hyst_real line = branch->ahead * preisach_far(model, branch, k) +
                           branch->behind * preisach_near(model, branch, k);
    return line - branch->bend;
}

static hyst_preisach_point preisach_point_at(const hyst_preisach *model, const preisach_branch *branch,
                                             hyst_real u, hyst_real way)
{
    const hyst_real along = model->p0 * preisach_size(u - branch->start.u) + way;
    const hyst_preisach_point point = {
        u, branch->rising ? branch->start.y + along : branch->start.y - along};
    return point;
}

static preisach_branch preisach_branch_of(const hyst_preisach *model, const hyst_preisach_point *start,
                                          int rising)
{
    const hyst_real *t = model->threshold;
    const hyst_real low = t[0], high = t[model->cells];
    const hyst_real limited = start->u < low ? low : start->u;
    preisach_branch branch;
    branch.start = *start;
    branch.rising = rising;
    branch.entry = limited > high ? high : limited;
    branch.cell = rising ? preisach_cell_above(model, branch.entry)
                         : preisach_cell_below(model, branch.entry);
    const hyst_real begin = t[branch.cell], end = t[branch.cell + 1u];
    branch.ahead = (rising ? end - branch.entry : branch.entry - begin) / (end - begin);
    branch.behind = (rising ? branch.entry - begin : end - branch.entry) / (end - begin);
    branch.bend =
        model->ridges ? HYST_REAL(0.0)
                      : branch.behind *
                            (branch.ahead * preisach_entry(model, branch.cell + 1u, branch.cell));
    return branch;
}

/* The piece outside the grid, where relays rest: from a point on, to another one or for ever. */
static hyst_preisach_piece preisach_outside(const hyst_preisach *model, const preisach_branch *branch,
                                            hyst_preisach_point from)
{
    hyst_preisach_piece piece;
    piece.from = from;
    piece.to = from;
    piece.width = branch->rising ? HYST_REAL(1.0) : HYST_REAL(-1.0);
    piece.line = model->p0;
    piece.square = HYST_REAL(0.0);
    piece.rising = branch->rising;
    piece.has_end = 0;
    return piece;
}

/* The piece of a branch in a cell that it crosses, or starts in. */
static hyst_preisach_piece preisach_in_cell(const hyst_preisach *model, const preisach_branch *branch,
                                            size_t cell)
{
    const int is_first = cell == branch->cell;
    const size_t near = branch->rising ? cell : cell + 1u, far = branch->rising ? cell + 1u : cell;
    const hyst_real before = is_first ? HYST_REAL(0.0) : preisach_way(model, branch, near);
    const hyst_real after = preisach_way(model, branch, far);
    const hyst_real rise = after - before;
    const hyst_real triangle = is_first ? rise : preisach_entry(model, cell + 1u, cell);
    const hyst_real begin = is_first ? branch->entry : model->threshold[near];
    const int is_straight = model->ridges != 0;
    hyst_preisach_piece piece;
    piece.from = preisach_point_at(model, branch, begin, before);
    piece.to = preisach_point_at(model, branch, model->threshold[far], after);
    piece.width = piece.to.u - begin;
    piece.square = is_straight ? HYST_REAL(0.0)
                               : (triangle > rise ? HYST_ROUNDED(triangle, rise) : triangle);
    piece.line = (rise - piece.square) + model->p0 * preisach_size(piece.width);
    piece.rising = branch->rising;
    piece.has_end = 1;
    return piece;
}

/* Where ridges bend: in each cell after the first, as far into it as the start was into its own. */
static hyst_preisach_point preisach_bend(const hyst_preisach *model, const preisach_branch *branch,
                                         size_t cell, const hyst_preisach_piece *whole)
{
    const size_t near = branch->rising ? cell : cell + 1u, far = branch->rising ? cell + 1u : cell;
    const hyst_real others =
        preisach_near(model, branch, far) - preisach_near(model, branch, near);
    const hyst_real rise =
        branch->behind * (others + model->p0 * preisach_size(whole->width));
    const hyst_real y = branch->rising ? whole->from.y + rise : whole->from.y - rise;
    const int is_beyond = branch->rising ? y > whole->to.y : y < whole->to.y;
    const hyst_preisach_point bend = {whole->from.u + branch->behind * whole->width,
                                      is_beyond ? HYST_ROUNDED(y, whole->to.y) : y};
    return bend;
}

static hyst_preisach_piece preisach_part(const hyst_preisach_piece *whole, hyst_preisach_point bend,
                                         int is_second)
{
    hyst_preisach_piece part = *whole;
    part.from = is_second ? bend : whole->from;
    part.to = is_second ? whole->to : bend;
    part.width = part.to.u - part.from.u;
    part.line = preisach_size(part.to.y - part.from.y);
    return part;
}

static int preisach_has_bend(const hyst_preisach *model, const preisach_branch *branch, size_t cell)
{
    return model->ridges != 0 && cell != branch->cell && branch->behind > HYST_REAL(0.0);
}

/* The piece of the first loading curve from knot k on. */
static hyst_preisach_piece preisach_first_loading(const hyst_preisach *model, int rising, size_t k)
{
    const hyst_real *row = (rising ? model->rising : model->falling) + 4u * k;
    const size_t knots = rising ? model->rising_knots : model->falling_knots;
    const hyst_real from = rising ? row[0] : -row[0];
    hyst_preisach_piece piece;
    piece.from.u = from;
    piece.from.y = row[1] + model->p0 * from;
    piece.to = piece.from;
    piece.width = rising ? HYST_REAL(1.0) : HYST_REAL(-1.0);
    piece.line = model->p0;
    piece.square = HYST_REAL(0.0);
    piece.rising = rising;
    piece.has_end = k + 1u < knots;
    if (piece.has_end != 0) {
        piece.to.u = rising ? row[4] : -row[4];
        piece.to.y = row[5] + model->p0 * piece.to.u;
        piece.width = piece.to.u - from;
        piece.line = row[2] + model->p0 * preisach_size(piece.width);
        piece.square = row[3];
    }
    return piece;
}

static hyst_preisach_piece preisach_first_to_output(const hyst_preisach *model, hyst_real y)
{
    const int rising = y > model->rising[1];
    const hyst_real *table = rising ? model->rising : model->falling;
    size_t low = 0, high = rising ? model->rising_knots : model->falling_knots;
    while (high - low > 1u) {
        const size_t middle = low + (high - low) / 2u;
        const hyst_real u = rising ? table[4u * middle] : -table[4u * middle];
        if (hyst_preisach_is_past(rising, y, table[4u * middle + 1u] + model->p0 * u)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return preisach_first_loading(model, rising, low);
}

hyst_preisach_piece hyst_preisach_to_input(const hyst_preisach *model, const hyst_preisach_point *start,
                                           hyst_real u)
{
    const hyst_real *t = model->threshold;
    const hyst_real zero = HYST_REAL(0.0);
    if (start == NULL) {
        const int rising = u > zero;
        const size_t knots = rising ? model->rising_knots : model->falling_knots;
        const hyst_real *table = rising ? model->rising : model->falling;
        return preisach_first_loading(model, rising,
                                      preisach_halving(table, knots, 4u, preisach_size(u)));
    }
    const int rising = u > start->u;
    const preisach_branch branch = preisach_branch_of(model, start, rising);
    const hyst_real end = rising ? t[model->cells] : t[0];
    if (hyst_preisach_is_past(rising, u, branch.entry) == 0) {
        return preisach_outside(model, &branch, *start);
    }
    if (hyst_preisach_is_past(rising, u, end) != 0) {
        const int crosses = hyst_preisach_is_past(rising, end, branch.entry);
        const hyst_real way = crosses ? preisach_way(model, &branch, rising ? model->cells : 0u) : zero;
        return preisach_outside(
            model, &branch,
            crosses ? preisach_point_at(model, &branch, end, way) : branch.start);
    }
    const size_t cell = rising ? preisach_cell_below(model, u) : preisach_cell_above(model, u);
    const hyst_preisach_piece whole = preisach_in_cell(model, &branch, cell);
    if (preisach_has_bend(model, &branch, cell) == 0) {
        return whole;
    }
    const hyst_preisach_point bend = preisach_bend(model, &branch, cell, &whole);
    return preisach_part(&whole, bend, hyst_preisach_is_past(rising, u, bend.u));
}

/* The cell of a branch, from its first on, that ends at or past an output; `cells` if none does. */
static size_t preisach_cell_of_output(const hyst_preisach *model, const preisach_branch *branch,
                                      hyst_real y)
{
    const hyst_real *t = model->threshold;
    size_t low = 0, high = branch->rising ? model->cells - branch->cell : branch->cell + 1u;
    const size_t crossed = high;
    while (low < high) {
        const size_t middle = low + (high - low) / 2u;
        const size_t k = branch->rising ? branch->cell + 1u + middle : branch->cell - middle;
        const hyst_preisach_point edge =
            preisach_point_at(model, branch, t[k], preisach_way(model, branch, k));
        if (hyst_preisach_is_past(branch->rising, y, edge.y) != 0) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    if (low == crossed) {
        return model->cells;
    }
    return branch->rising ? branch->cell + low : branch->cell - low;
}

hyst_preisach_piece hyst_preisach_to_output(const hyst_preisach *model, const hyst_preisach_point *start,
                                            hyst_real y)
{
    const hyst_real *t = model->threshold;
    if (start == NULL) {
        return preisach_first_to_output(model, y);
    }
    const int rising = y > start->y;
    const preisach_branch branch = preisach_branch_of(model, start, rising);
    const hyst_real end = rising ? t[model->cells] : t[0];
    const hyst_preisach_point entry =
        preisach_point_at(model, &branch, branch.entry, HYST_REAL(0.0));
    const int crosses = hyst_preisach_is_past(rising, end, branch.entry);
    if (!crosses || !hyst_preisach_is_past(rising, y, entry.y)) {
        return preisach_outside(model, &branch, *start);
    }
    const size_t cell = preisach_cell_of_output(model, &branch, y);
    if (cell == model->cells) {
        const hyst_real way = preisach_way(model, &branch, rising ? model->cells : 0u);
        return preisach_outside(model, &branch, preisach_point_at(model, &branch, end, way));
    }
    const hyst_preisach_piece whole = preisach_in_cell(model, &branch, cell);
    if (preisach_has_bend(model, &branch, cell) == 0) {
        return whole;
    }
    const hyst_preisach_point bend = preisach_bend(model, &branch, cell, &whole);
    return preisach_part(&whole, bend, hyst_preisach_is_past(rising, y, bend.y));
}
