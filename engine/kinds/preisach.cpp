// The Preisach operator and its inverse: from masses of cells to tables of what the output moves by.
#include "hyst/preisach.h"

#include <algorithm>

#include "fast/preisach.hpp"
#include "kind.hpp"

namespace hyst {
namespace HYST_KINDS {
namespace {

// The grid with twice the mass of every cell: what the output moves by when its relays turn. Seen in
// the mirror, u for -u and y for -y, a falling input rises.
struct Grid {
    std::size_t cells;
    Reals level;
    Reals mass;  // (n, n), row by row
    bool ridges;

    hyst_real at(std::size_t i, std::size_t j) const { return mass[i * cells + j]; }
    hyst_real width(std::size_t i) const { return level[i + 1] - level[i]; }

    Grid mirrored() const {
        Grid other = *this;
        for (std::size_t k = 0; k <= cells; ++k) other.level[k] = -level[cells - k];
        for (std::size_t i = 0; i < cells; ++i) {
            for (std::size_t j = 0; j < cells; ++j) {
                other.mass[i * cells + j] = at(cells - 1 - j, cells - 1 - i);
            }
        }
        return other;
    }
};

Grid grid_of(const Given &given) {
    const Reals level = given.kept("thresholds");
    const std::size_t n = level.size() - 1;
    given.require(level.size() > 1 && given.constants.size() == 1 + n * (n + 1) / 2);
    Grid grid{n, level, Reals(n * n, HYST_REAL(0.0)), given.choices.at("ridges") != 0};
    std::size_t next = 1;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            grid.mass[i * n + j] = HYST_REAL(2.0) * given.constants[next++];
        }
    }
    return grid;
}

// Row after row adds what its cells from column j on hold; so entries rise with i and fall with j,
// whatever rounding does.
Reals everett_of(const Grid &grid) {
    const std::size_t n = grid.cells;
    Reals table((n + 1) * (n + 2) / 2, HYST_REAL(0.0));
    for (std::size_t i = 0; i < n; ++i) {
        hyst_real row = HYST_REAL(0.0);
        for (std::size_t j = i + 1; j-- > 0;) {
            row = row + grid.at(i, j);
            table[(i + 1) * (i + 2) / 2 + j] = table[i * (i + 1) / 2 + j] + row;
        }
    }
    return table;
}

// Where the line alpha + beta = 0 enters the line of mass of a cell, as a part of that.
hyst_real part_below(const Grid &grid, std::size_t i, std::size_t j) {
    const hyst_real part = -(grid.level[i] + grid.level[j]) / (grid.width(i) + grid.width(j));
    if (part < HYST_REAL(0.0)) return HYST_REAL(0.0);
    return part > HYST_REAL(1.0) ? HYST_REAL(1.0) : part;
}

// Sizes of inputs at which the first loading curve may bend, ascending from 0.
Reals knots_of(const Grid &grid) {
    Reals knots{HYST_REAL(0.0)};
    for (const hyst_real &level : grid.level) {
        knots.push_back(level < HYST_REAL(0.0) ? -level : level);
    }
    for (std::size_t i = 0; grid.ridges && i < grid.cells; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            const hyst_real part = part_below(grid, i, j);
            const hyst_real knot = grid.level[i] + part * grid.width(i);
            if (part > HYST_REAL(0.0) && part < HYST_REAL(1.0) && knot > HYST_REAL(0.0)) {
                knots.push_back(knot);
            }
        }
    }
    std::sort(knots.begin(), knots.end());
    knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
    return knots;
}

struct Rise {
    hyst_real line = HYST_REAL(0.0), square = HYST_REAL(0.0);
};

// Of the relays with alpha + beta > 0 what turns while the input rises from one knot to the next.
Rise even_rise(const Grid &grid, std::size_t i, hyst_real from, hyst_real to) {
    const hyst_real middle = HYST_REAL(0.5) * (from + to), step = to - from;
    const hyst_real share = step / grid.width(i);  // of the row's width
    Rise rise;
    for (std::size_t j = 0; j < i; ++j) {
        const hyst_real end = grid.level[j + 1], width = grid.width(j);
        if (grid.level[j] >= -middle) {
            rise.line = rise.line + grid.at(i, j) * share;
        } else if (end > -middle) {  // beta from -u on
            rise.line = rise.line + grid.at(i, j) * ((end + from) / width) * share;
            rise.square = rise.square + HYST_REAL(0.5) * grid.at(i, j) * (step / width) * share;
        }
    }
    const hyst_real triangle = grid.at(i, i);
    if (grid.level[i] >= -middle) {  // beta from its own lower edge to u
        const hyst_real before = (from - grid.level[i]) / grid.width(i);
        rise.line = rise.line + HYST_REAL(2.0) * triangle * before * share;
        rise.square = rise.square + triangle * share * share;
    } else {  // from -u to u
        rise.line = rise.line + HYST_REAL(4.0) * triangle * (from / grid.width(i)) * share;
        rise.square = rise.square + HYST_REAL(2.0) * triangle * share * share;
    }
    return rise;
}

Rise ridge_rise(const Grid &grid, std::size_t i, hyst_real from, hyst_real to) {
    const hyst_real middle = HYST_REAL(0.5) * (from + to), share = (to - from) / grid.width(i);
    Rise rise;
    for (std::size_t j = 0; j <= i; ++j) {
        const hyst_real first = grid.level[i] + part_below(grid, i, j) * grid.width(i);
        if (first < middle) rise.line = rise.line + grid.at(i, j) * share;
    }
    return rise;
}

// Knots and rises between them, without the outputs.
Reals first_loading(const Grid &grid) {
    Reals table;
    const Reals knots = knots_of(grid);
    for (std::size_t k = 0; k < knots.size(); ++k) {
        Rise rise;
        if (k + 1 < knots.size()) {
            const hyst_real middle = HYST_REAL(0.5) * (knots[k] + knots[k + 1]);
            for (std::size_t i = 0; i < grid.cells; ++i) {
                if (!(grid.level[i] < middle && middle < grid.level[i + 1])) continue;
                rise = grid.ridges ? ridge_rise(grid, i, knots[k], knots[k + 1])
                                   : even_rise(grid, i, knots[k], knots[k + 1]);
            }
        }
        table.insert(table.end(), {knots[k], HYST_REAL(0.0), rise.line, rise.square});
    }
    return table;
}

// What the output moves by up to the last knot.
hyst_real whole_rise(const Reals &table) {
    hyst_real sum = HYST_REAL(0.0);
    for (std::size_t k = 0; k < table.size(); k += 4) sum = sum + (table[k + 2] + table[k + 3]);
    return sum;
}

void fill_outputs(Reals &table, hyst_real start, bool is_rising) {
    hyst_real y = start;
    for (std::size_t k = 0; k < table.size(); k += 4) {
        table[k + 1] = y;
        const hyst_real rise = table[k + 2] + table[k + 3];
        y = is_rising ? y + rise : y - rise;
    }
}

// p0, then the lower triangle of masses row by row.
void derive_preisach(const Given &given, Constants &made) {
    const Grid grid = grid_of(given);
    const std::size_t n = grid.cells;
    Reals rising = first_loading(grid), falling = first_loading(grid.mirrored());
    // Relays with alpha + beta < 0 are up: the output lies between both ends as they weigh.
    const hyst_real start = HYST_REAL(0.5) * (whole_rise(falling) - whole_rise(rising));
    fill_outputs(rising, start, true);
    fill_outputs(falling, start, false);
    made.table("threshold", grid.level, not_offered);
    made.number("per_input", hyst_real(static_cast<double>(n)) / (grid.level[n] - grid.level[0]),
                not_offered);
    made.table("everett", everett_of(grid), not_offered);
    made.table("rising", std::move(rising), not_offered);
    made.table("falling", std::move(falling), not_offered);
    made.number("p0", given.constants[0], not_offered);
    made.choose("cells", n);
    made.choose("rising_knots", made.size("rising") / 4);
    made.choose("falling_knots", made.size("falling") / 4);
    for (const char *each : {"ridges", "inverse", "depth"}) made.choose(each, given.choices.at(each));
    made.structure =
        "hyst_preisach $model = {#cells, $threshold, $per_input, $everett, #rising_knots, $rising, "
        "#falling_knots, $falling, $p0, $ridges, $inverse, #depth};";
}

const void *fill_preisach(Constants &of) {
    return of.hold(hyst_preisach{of.choice("cells"), of.table("threshold"), of.number("per_input"),
                                 of.table("everett"), of.choice("rising_knots"), of.table("rising"),
                                 of.choice("falling_knots"), of.table("falling"), of.number("p0"),
                                 of.is("ridges"), of.is("inverse"), of.choice("depth")});
}

}  // namespace

extern const Kind preisach;

const Kind preisach = {
    "preisach",
    &hyst_preisach_kind,
    derive_preisach,
    fill_preisach,
    {"hyst/preisach.h", "$signal = hyst_preisach_step(&$model, $memory, $signal);"},
    HYST_IN_DOUBLE(preisach_jacobian),
    HYST_IN_DOUBLE(run_preisach),
    nullptr};

}  // namespace HYST_KINDS
}  // namespace hyst
