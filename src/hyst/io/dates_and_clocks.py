"""A date in one column and the time of day in the next are one stamp."""

from __future__ import annotations

import re
from collections.abc import Sequence

from hyst.io.cell_values import ColumnOfCells
from hyst.io.stamps import seconds_of_stamps

_DATE = re.compile(r"\d{1,4}[-/.](?:\d{1,2}|[A-Za-z]{3})[-/.]\d{1,4}", re.ASCII)
_CLOCK = re.compile(r"\d{1,2}:\d{2}.*", re.ASCII)


def with_clocks(
    columns: Sequence[ColumnOfCells], cells: Sequence[Sequence[str]]
) -> list[ColumnOfCells]:
    """Make the column of dates one of stamps where that beside it holds times of day.

    Parameters
    ----------
    columns
        What the cells say, column by column.
    cells
        The cells of each column.

    Returns
    -------
    list of ColumnOfCells
        The same columns, but seconds since the first stamp in those of dates.

    Examples
    --------
    >>> from hyst.io.cell_values import read_cells
    >>> cells = [["2026-11-28", "2026-11-29"], ["23:59:59", "00:00:01"]]
    >>> with_clocks([read_cells(each, ".") for each in cells], cells)[0].values.tolist()
    [0.0, 2.0]
    """
    found = list(columns)
    for k in range(len(found) - 1):
        if not (found[k].stamps and found[k + 1].stamps):
            continue
        for dates, clocks in ((k, k + 1), (k + 1, k)):
            if _DATE.fullmatch(cells[dates][0]) and _CLOCK.fullmatch(cells[clocks][0]):
                joined = [f"{a} {b}" for a, b in zip(cells[dates], cells[clocks], strict=True)]
                stamps = seconds_of_stamps(joined)
                note = "taken together with the time of day in the column beside it"
                notes = (note, *stamps.notes)
                found[dates] = ColumnOfCells(stamps.seconds, stamps.flaw, "s", "", notes, True)
    return found
