"""Measured repetitions of a motion: files in, at the sample time of the reference."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import hyst
from hyst.cli.arguments import require_same_unit
from hyst.cli.driver_option import volts_of_record
from hyst.cli.reading_options import read_told

_LARGEST_MISFIT = 0.01  # of a sample time, however short the reference


@dataclass(frozen=True)
class Measured:
    """A record with one repetition or several.

    Parameters
    ----------
    name
        Of its file, for people.
    record
        Drive and output at the sample time of the reference.
    notes
        What was done to it.
    """

    name: str
    record: hyst.Record
    notes: tuple[str, ...] = ()


def read_measured(
    files: Sequence[Path],
    how: dict[str, Any],
    about: hyst.ModelDescription,
    output_unit: str,
    dt: float | None,
    driver: hyst.Driver | None = None,
) -> list[hyst.Record]:
    """Read the records of all files, in their order.

    Parameters
    ----------
    files
        As typed.
    how
        Options of reading.
    about
        Of the model, for units.
    output_unit
        Of the reference, or of the model if the reference says none.
    dt
        Sample time of files that tell none, s.
    driver
        Of drives that say that they are in codes.

    Raises
    ------
    InputError
        If a column is not named, a file cannot be read, or a unit is another one.
    """
    if not files:
        return []
    for option in ("input", "output"):
        if how[option] is None:
            raise hyst.InputError(
                f"measured files are given and no --{option}; name the column of the "
                f"{'applied drive' if option == 'input' else 'measured output'} in them"
            )
    if how["output_file"] is not None and len(files) > 1:
        raise hyst.InputError(
            f"--output-file is the output of one record, and {len(files)} are given; give files "
            "that hold both columns"
        )
    how = how | {"table": None if how["table"] is None else str(how["table"]), "one_way": True}
    read = [_read(path, how, dt) for path in files]
    records = [volts_of_record(each, None, driver) for each in read]
    for path, record in zip(files, records, strict=True):
        require_same_unit(record.input_unit, about.input_unit, f"the drive in {path.name}")
        require_same_unit(record.output_unit, output_unit, f"the output in {path.name}")
    return records


def _read(path: Path, how: dict[str, Any], dt: float | None) -> hyst.Record:
    """Read a record; where its times are not told, by its time column or that of the reference."""
    try:
        return read_told(path, **how)[0]
    except hyst.InputError as error:
        if "neither of rate and time" not in str(error):
            raise
        of_file = {name: how[name] for name in ("format", "max_samples")}
        found = hyst.io.read_time_step(path, table=_number(how["table"]), **of_file)
        if found is not None and found[1] is not None:
            return read_told(path, **how | {"time": found[0]})[0]
        if dt is None:
            raise
        return read_told(path, **how | {"rate": 1.0 / dt})[0]


def _number(table: str | None) -> int | None:
    return None if table is None else int(table)


def at_rate_of_reference(
    name: str, record: hyst.Record, dt: float | None, samples: int
) -> Measured:
    """Bring a record to the sample time of the reference, if it has a whole multiple of it.

    Parameters
    ----------
    name
        Of the file.
    record
        As read.
    dt
        Sample time of the reference, s; None if nothing tells it.
    samples
        Of the reference.

    Raises
    ------
    InputError
        If the record has another sample time, and no whole part of the reference's.
    """
    if dt is None:
        return Measured(name, record)
    ratio = dt / record.dt
    every = max(round(ratio), 1)
    # Stamps are rounded: what adds up to a sample over the whole reference is another rate.
    if abs(ratio / every - 1.0) > min(_LARGEST_MISFIT, 1.0 / samples):
        raise hyst.InputError(
            f"{name} has {record.rate:.6g} samples per second and the reference {1.0 / dt:.6g}; "
            "record at the rate of the reference or at a whole multiple of it, or say with "
            "--rate or --reference-rate what the rates really are"
        )
    if every == 1:
        return Measured(name, record)
    thinned = replace(record, u=record.u[::every], y=record.y[::every], dt=record.dt * every)
    said = f"has {every} samples for each of the reference; every {_ordinal(every)} is used"
    return Measured(name, thinned, (said,))


def _ordinal(number: int) -> str:
    ends = {1: "st", 2: "nd", 3: "rd"}
    tail = "th" if number % 100 in (11, 12, 13) else ends.get(number % 10, "th")
    return f"{number}{tail}"
