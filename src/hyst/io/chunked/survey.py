"""The first way through a file that is read in chunks: what a record needs, checked once."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from hyst.io.chunked.codes_check import CodesCheck
from hyst.io.chunked.pieces import Array, Columns, Piece
from hyst.io.chunked.stamps_check import StampsCheck
from hyst.io.chunked.turns_check import Turns
from hyst.io.columns import notes_about, refuse_doubts, refuse_flaws
from hyst.io.own_times import refuse_own_times
from hyst.io.record_of_table import Wanted, choose_columns, refuse_unusable, step_of_rows
from hyst.io.table import Table
from hyst.io.unit_of_stamps import unit_of_stamps
from hyst.io.usable_rows import FEWEST_SAMPLES, refuse_row_of_units, require_samples
from hyst.signals import Record

_REMEDY = ", or read the record as a whole with read_record and repair"


@dataclass(frozen=True)
class Survey:
    """What was found out about a record.

    Parameters
    ----------
    columns
        Indices of input and output.
    samples
        How many there are.
    dt
        Seconds between them.
    notes
        What is to be told, one sentence each.
    """

    columns: tuple[int, int]
    samples: int
    dt: float
    notes: tuple[str, ...]


def survey(columns: Columns, wanted: Wanted) -> Survey:
    """Go through a file once.

    Parameters
    ----------
    columns
        Of the file.
    wanted
        Which of them, and how; nothing is repaired.

    Raises
    ------
    InputError
        As ``read_record``.
    """
    table = columns.table
    chosen = choose_columns(table, wanted.columns())
    for k in chosen[:2]:
        refuse_doubts(table, k)
    codes, turns = CodesCheck(chosen[:2]), Turns(wanted.dead_band)
    stamps, told, samples = None, tuple[str, ...](), 0
    low, high, first = np.inf, -np.inf, None
    for piece in columns.pieces(chosen):
        here = checked(table, piece, chosen)
        if wanted.time is not None and stamps is None:
            _refuse_other_stamps(columns, piece, chosen, wanted)
            seconds, told = unit_of_stamps(here, chosen[2], piece.values[2], wanted.time_unit)
            stamps = StampsCheck(seconds)
        if stamps is not None:
            stamps.add(here, piece, piece.values[2])
        codes.add(here, piece)
        turns.add(piece.values[0])
        low, high = min(low, piece.values[1].min()), max(high, piece.values[1].max())
        first = piece if first is None else first
        samples += piece.size
    require_samples(table, np.arange(min(samples, FEWEST_SAMPLES)))
    codes.refuse(_REMEDY)
    if stamps is not None:
        dt, noted = stamps.result()
    else:
        dt, noted = step_of_rows(table, wanted)
    if first is not None and first.size == samples:
        _refuse(table, chosen, wanted, first.values[0], first.values[1], wanted.dead_band)
    else:
        u = turns.signal()
        _refuse(table, chosen, wanted, u, np.linspace(low, high, u.size), turns.dead_band())
    notes = (*notes_about(table, chosen), *told, *noted)
    return Survey((chosen[0], chosen[1]), samples, dt, notes)


def checked(table: Table, piece: Piece, chosen: list[int]) -> Table:
    """Give a table that says where rows of a piece are; refuse what is no finite number in it.

    Parameters
    ----------
    table, piece, chosen
        Of the file, some of its rows, and which columns they are.

    Raises
    ------
    InputError
        If there is such a thing.
    """
    here = piece.placed(table, chosen)
    if any(flaw is not None for flaw in piece.flaws):
        refuse_row_of_units(here, chosen)
        for k in chosen:
            refuse_flaws(here, k, f"correct it{_REMEDY}")
    return here


def _refuse_other_stamps(columns: Columns, piece: Piece, chosen: list[int], wanted: Wanted) -> None:
    """Refuse signals with stamps of their own, by the first rows."""
    none = np.empty(0)
    known = dict(zip(chosen, piece.values, strict=True))
    every = tuple(known.get(k, none) for k in range(len(columns.table.names)))
    start = replace(columns.table, columns=every)

    def read(column: int) -> Array:
        return known[column] if column in known else next(columns.pieces([column])).values[0]

    refuse_own_times(start, {"input": chosen[0], "output": chosen[1]}, chosen[2], read)


def _refuse(
    table: Table, chosen: list[int], wanted: Wanted, u: Array, y: Array, dead_band: float | None
) -> None:
    """Refuse signals that stand still, or an input that does not turn."""
    names = (table.names[chosen[0]], table.names[chosen[1]])
    refuse_unusable(table.source, Record(u, y, 1.0, *names), dead_band, wanted.one_way)
