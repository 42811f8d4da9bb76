"""A file as it is seen before anything is said of it: a small plot of each column."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hyst.io import ColumnSummary, read_table, summarize_file
from hyst.studio.drawing.extremes import extreme_samples
from hyst.studio.drawing.plot import Line, Plot
from hyst.studio.work.choice import Choice

MOST_COLUMNS = 60
_WIDTH, _HEIGHT = 240, 70


@dataclass(frozen=True)
class Look:
    """What a file holds.

    Parameters
    ----------
    columns
        Each with its small plot as SVG; of very many the first ones.
    guess
        What its columns may be, to be checked by the user.
    notes
        Sentences about what is no column, or is not shown.
    """

    columns: tuple[tuple[ColumnSummary, str], ...]
    guess: Choice
    notes: tuple[str, ...]


def look(path: Path, table: int | None, tell: Callable[..., None]) -> Look:
    """Look at a file.

    Parameters
    ----------
    path
        The file.
    table
        Which of its tables; None for the only one.
    tell
        Not told anything.

    Raises
    ------
    InputError
        If it cannot be read.
    """
    summary = summarize_file(path, table=table)
    shown = summary.columns[:MOST_COLUMNS]
    values = read_table(path, table=table, columns=[each.index for each in shown]).columns
    drawn = tuple((each, _sketch(each, values[k])) for k, each in enumerate(shown))
    roles = {each.guess: each.index for each in summary.columns if each.guess}
    guess = Choice(roles.get("input"), roles.get("output"), roles.get("time"), table=table)
    notes = [f"{name!r} {why}" for name, why in summary.left_out if why != "is a single number"]
    if len(summary.columns) > len(shown):
        notes.append(f"only the first {MOST_COLUMNS} of {len(summary.columns)} columns are shown")
    return Look(drawn, guess, tuple(notes[:8]))


def _sketch(column: ColumnSummary, values: np.ndarray) -> str:
    told = f"{column.name} over the rows of the file: {column.low:.4g} to {column.high:.4g}"
    if not column.low <= column.high:
        told = f"{column.name}: no numbers"
    finite = np.isfinite(values)
    rows = np.flatnonzero(finite)
    if not rows.size:
        return Plot((), "", "", told, _WIDTH, _HEIGHT).svg()
    seen = values[rows]
    chosen = extreme_samples(_WIDTH, seen)
    line = Line(rows[chosen].astype(float), seen[chosen])
    return Plot((line,), "", "", told, _WIDTH, _HEIGHT).svg()
