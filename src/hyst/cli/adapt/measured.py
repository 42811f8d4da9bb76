"""The record, side by side with its input, split into what sets the memory and what teaches."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.cli.arguments import require_same_unit
from hyst.cli.driver_option import volts_of_record
from hyst.cli.reading_options import read_told

Array = NDArray[np.float64]


@final
@dataclass(frozen=True, eq=False)
class Measured:
    """What is learnt from.

    Parameters
    ----------
    whole
        The record as it was read.
    history
        Shape (start,), inputs that only set the memory.
    record
        What is learnt from, the delay of the model taken off.
    y_ref
        Wanted output, as long as the record; None if there is none.
    """

    whole: hyst.Record
    history: Array
    record: hyst.Record
    y_ref: Array | None


def read_measured(
    data: Path,
    how: dict[str, Any],
    about: hyst.operators.ModelDescription,
    start: int,
    wanted: str | None,
) -> Measured:
    """Read a record, and a column of the wanted output if there is one.

    Parameters
    ----------
    data, how
        The file, and how it is read.
    about
        Of the model: its delay, and the unit of its output.
    start
        First sample to learn from.
    wanted
        Column of the wanted output.

    Raises
    ------
    InputError
        If there are several records, too few samples are left, or the wanted output has another
        length or unit.
    """
    records = read_told(data, **how)
    if len(records) > 1:
        raise hyst.InputError(
            f"--table all gives {len(records)} records, adapt takes one; name one"
        )
    whole = volts_of_record(records[0], None, about.driver)
    ahead, behind = _shifts(whole, about.delay)
    record = _without_delay(whole, about.delay, ahead, behind)
    if start > record.samples - 2:
        raise hyst.InputError(
            f"--start is {start} but the record has {record.samples} samples; leave two or more to "
            "learn from"
        )
    y_ref = None
    if wanted is not None:
        y_ref = _wanted(data, how, wanted, whole, about.output_unit)
        y_ref = y_ref[behind : whole.samples - ahead][start:]
    return Measured(whole, record.u[:start], record.slice(start, record.samples), y_ref)


def _shifts(record: hyst.Record, delay: float) -> tuple[int, int]:
    """Give how many samples of input and of output have no counterpart in front."""
    whole = math.floor(delay)
    if abs(whole) >= record.samples:
        raise hyst.InputError(
            f"the model's delay is {delay:.4g} samples but the record has {record.samples}; "
            "give a longer record"
        )
    return max(-whole, 0), max(whole, 0)


def _without_delay(record: hyst.Record, delay: float, ahead: int, behind: int) -> hyst.Record:
    """Set input and output side by side; part of a sample is taken off the input."""
    if delay == 0:
        return record
    part = delay - math.floor(delay)
    u = hyst.identification.later(record.u, part)[ahead : record.samples - behind]
    return replace(record, u=u, y=record.y[behind : record.samples - ahead])


def _wanted(
    data: Path, how: dict[str, Any], column: str, record: hyst.Record, output_unit: str
) -> Array:
    table = how.get("table")
    values, name, unit = hyst.io.read_column(
        data,
        column,
        table=None if table is None else int(table),
        format=how.get("format"),
        max_samples=how["max_samples"],
    )
    require_same_unit(unit, output_unit, f"the wanted output {name!r}")
    if values.size != record.samples:
        raise hyst.InputError(
            f"the wanted output {name!r} has {values.size} samples but the record "
            f"{record.samples}, since rows were left out or made; give a file without --repair and "
            "--resample"
        )
    return np.array(values)
