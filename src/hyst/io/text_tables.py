"""Find the tables in a text file: where each begins, its rows, and what stands around them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.io.cells import is_missing
from hyst.io.header import split_unit
from hyst.io.line_kinds import MIXED, NUMERIC, TEXT, LineKinds
from hyst.io.notation import SAMPLED, Writing

# A run of so many lines of numbers is a table of its own.
_FEWEST_ROWS = 3
# Beside so many rows an odd line at either end is no row; beside fewer it may be.
ENOUGH_ROWS = 10
_LONGEST_FOOTER = 200


@dataclass(frozen=True)
class Block:
    """A table in a text file; all are indices of lines.

    Parameters
    ----------
    above
        First line of what stands above the table.
    first, stop
        First row, and one past the last.
    count
        Cells in a row.
    faulty
        Lines among the rows that have another number of cells.
    loose
        Lines left out above the first row or below the last that hold numbers or text.
    """

    above: int
    first: int
    stop: int
    count: int
    faulty: tuple[int, ...] = ()
    loose: tuple[int, ...] = ()


class Heads:
    """What stands above a table, to know its header again where it stands among the rows."""

    def __init__(self, above: Sequence[str], writing: Writing) -> None:
        self._writing = writing
        self._last = above[-1].strip() if above else ""
        self._names = [names for line in above if (names := self._sorted_names(line))]

    def again(self, line: str) -> bool:
        """Tell whether a line is the header, or its names in another order or with other units."""
        if self._last and line.strip() == self._last:
            return True
        names = self._sorted_names(line)
        return bool(names) and names in self._names

    def _sorted_names(self, line: str) -> list[str]:
        titles = [split_unit(title.strip())[0] for title in self._writing.titles(line)]
        missing = any(map(is_missing, titles))
        return [] if missing else sorted(map(str.casefold, titles))


def find_blocks(
    lines: Sequence[str],
    kinds: LineKinds,
    after_gap: frozenset[int],
    writing: Writing,
    comments: Sequence[str] = (),
) -> list[Block]:
    """Find the tables below each other.

    Parameters
    ----------
    lines
        Lines without comments and blank ones.
    kinds
        Of what kind each is.
    after_gap
        Lines above which there is a blank line or comment.
    writing
        How the file is written.
    comments
        Those above all lines, where the header may be.

    Returns
    -------
    list of Block
        None if no line holds a number. A new table begins where the header stands again, where a
        header follows a gap or other lines of text, and where a run of rows has another number of
        cells. Every other line that is no row is a faulty one.

    Examples
    --------
    >>> from hyst.io.line_kinds import sort_lines
    >>> lines = ["u,y", "1,2", "3,4", "u,y", "5,6"]
    >>> commas = Writing(",", ".")
    >>> found = find_blocks(lines, sort_lines(lines, commas), frozenset(), commas)
    >>> [(each.first, each.stop) for each in found]
    [(1, 3), (4, 5)]
    """
    if not (kinds.kinds > TEXT).any():
        return []
    count = _usual_count(kinds)
    first = _first_row(lines, kinds, count, writing)
    usual = (kinds.counts == count) & (kinds.kinds > TEXT)
    above, start, faulty = 0, first, list[int]()
    found: list[Block] = []
    for low, high in _groups(np.flatnonzero(~usual[first:]) + first):
        inner = _tables_between(lines, kinds, after_gap, writing, low, high)
        ends = high == len(lines)
        # Words between blanks make as many cells as it happens.
        whole = writing.separator is not None and (kinds.counts[low:high] == count).all()
        heads = Heads([*(() if above else comments), *lines[above:start]], writing)
        if inner or (not ends and _begins_table(lines, kinds, after_gap, low, high, heads, count)):
            found += [Block(above, start, low, count, tuple(faulty)), *inner]
            above, start, faulty = (inner[-1].stop if inner else low), high, []
        elif ends and not whole and low - start >= ENOUGH_ROWS and high - low <= _LONGEST_FOOTER:
            block = Block(above, start, low, count, tuple(faulty), tuple(range(low, high)))
            return [*found, block]
        else:
            faulty += range(low, high)
    if start < len(lines):
        found.append(Block(above, start, len(lines), count, tuple(faulty)))
    return found


def _usual_count(kinds: LineKinds) -> int:
    """Give the number of cells that most lines of numbers have; of two the earlier one."""
    numeric = kinds.counts[kinds.kinds == NUMERIC]
    mixed = kinds.counts[kinds.kinds == MIXED]
    counts = numeric if 2 * numeric.size >= mixed.size and numeric.size else mixed
    values, firsts, times = np.unique(counts, return_index=True, return_counts=True)
    best = np.flatnonzero(times == times.max())
    return int(values[best[np.argmin(firsts[best])]])


def _groups(indices: NDArray[np.intp]) -> Iterator[tuple[int, int]]:
    """Give the runs of consecutive indices, each with one past its end."""
    if not indices.size:
        return
    cuts = np.flatnonzero(np.diff(indices) > 1) + 1
    for run in np.split(indices, cuts):
        yield int(run[0]), int(run[-1]) + 1


def _tables_between(
    lines: Sequence[str],
    kinds: LineKinds,
    after_gap: frozenset[int],
    writing: Writing,
    low: int,
    high: int,
) -> list[Block]:
    """Find tables of another number of columns among lines that are no rows."""
    own = kinds.cut(low, high)
    numeric = own.kinds == NUMERIC
    same = numeric[1:] & numeric[:-1] & (np.diff(own.counts) == 0)
    longest = max((b - a for a, b in _groups(np.flatnonzero(same))), default=0) + 1
    if longest < _FEWEST_ROWS or not (own.counts[numeric] > 1).any():
        return []
    inner = frozenset(row - low for row in after_gap)
    return [
        Block(
            each.above + low,
            each.first + low,
            each.stop + low,
            each.count,
            tuple(row + low for row in each.faulty),
            tuple(row + low for row in each.loose),
        )
        for each in find_blocks(lines[low:high], own, inner, writing)
        if each.stop - each.first >= _FEWEST_ROWS
    ]


def _begins_table(
    lines: Sequence[str],
    kinds: LineKinds,
    after_gap: frozenset[int],
    low: int,
    high: int,
    heads: Heads,
    count: int,
) -> bool:
    """Tell whether lines among rows are the head of another table."""
    if any(heads.again(lines[row]) for row in range(low, high) if kinds.kinds[row] == TEXT):
        return True
    named = kinds.kinds[high - 1] == TEXT and kinds.counts[high - 1] == count
    apart = any(row in after_gap for row in range(low, high)) or high - low > 1
    return bool(named and apart)


def _first_row(lines: Sequence[str], kinds: LineKinds, count: int, writing: Writing) -> int:
    """Find the line the rows start at.

    The last line of pure text before the first purely numeric line is the header if it has as
    many cells, and all before it is a preamble; so is what has another number of cells before
    it. Otherwise the rows start at the first line with a number in it, so that a faulty first
    row is reported and not taken for a header.
    """
    valued = np.flatnonzero((kinds.kinds > TEXT) & (kinds.counts == count))
    start = int(valued[0])
    numeric = valued[kinds.kinds[valued] == NUMERIC]
    if not numeric.size or numeric[0] - start > SAMPLED:
        return start
    first = int(numeric[0])
    if first and kinds.kinds[first - 1] == TEXT and _is_header(lines[first - 1], count, writing):
        return first
    if first > start and _is_preamble(lines[start:first], writing):
        return first
    return start


def _is_header(line: str, count: int, writing: Writing) -> bool:
    return count in {len(writing.titles(line)), len(writing.cells(line))} or count == 1


def _is_preamble(lines: Sequence[str], writing: Writing) -> bool:
    """Tell lines of a word and its value from faulty rows."""
    words = [writing.cells(line)[0] for line in lines]
    return (
        len(words) > 1
        and len(set(words)) == len(words)
        and all(sum(map(str.isalpha, word)) >= 4 for word in words)
    )
