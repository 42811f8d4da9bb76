"""hyst waveform: a command as a table, for controllers that run no code."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from numpy.typing import NDArray

import hyst
from hyst.checks.numbers import as_positive
from hyst.cli.arguments import (
    DespiteVerdict,
    history_of,
    numbers,
    refuse_inputs_as_outputs,
    require_same_unit,
)
from hyst.cli.console import note, show_files, show_table
from hyst.cli.driver_option import DriverOfCommand, driver_for, driver_of, says_codes
from hyst.cli.reading_options import reads_columns
from hyst.cli.scheduled import ScheduleValue, loaded_at
from hyst.report import Table

Signal = Annotated[
    Path,
    typer.Argument(
        metavar="SIGNAL",
        show_default=False,
        help="File with the command, or with --model the wanted output.",
    ),
]
Column = Annotated[
    str, typer.Option(metavar="COL", show_default=False, help="Its column: name or index from 0.")
]
Out = Annotated[
    Path, typer.Option("-o", "--out", metavar="FILE", show_default=False, help="CSV to write.")
]
Model = Annotated[
    Path | None,
    typer.Option(
        "--model",
        metavar="MODEL",
        show_default=False,
        help="Model file: the table is the exact command of the wanted output.",
    ),
]
Rate = Annotated[
    float | None,
    typer.Option(
        "--rate", metavar="HZ", show_default="its time column", help="Samples of SIGNAL per second."
    ),
]
ControllerRate = Annotated[
    float | None,
    typer.Option(metavar="HZ", show_default="as SIGNAL", help="Points of the table per second."),
]
Limits = Annotated[
    str | None,
    typer.Option(
        metavar="LOW,HIGH",
        show_default="of the model's record, or of the driver",
        help="Range of the drive, which every point is checked to keep.",
    ),
]
Slew = Annotated[
    float | None,
    typer.Option(metavar="X", show_default=False, help="Largest rate of the drive, per second."),
]
Bits = Annotated[
    int | None,
    typer.Option(
        metavar="N", show_default=False, help="Codes of N bits over the limits, without a driver."
    ),
]
Points = Annotated[
    int | None,
    typer.Option(metavar="N", show_default=False, help="Most points that the controller has."),
]
Repeat = Annotated[
    bool,
    typer.Option(
        "--repeat",
        help="The table is played again and again: its end must be its start, and with --model it "
        "is that of the steady cycle.",
    ),
]
History = Annotated[
    str | None,
    typer.Option(
        metavar="U,U,...|FILE:COLUMN",
        show_default=False,
        help="With --model: the drive just before, which sets the memory.",
    ),
]


@reads_columns
def waveform(
    signal: Signal,
    column: Column,
    out: Out,
    how: dict[str, Any],
    model: Model = None,
    rate: Rate = None,
    controller_rate: ControllerRate = None,
    limits: Limits = None,
    slew: Slew = None,
    driver: DriverOfCommand = None,
    bits: Bits = None,
    points: Points = None,
    repeat: Repeat = False,
    history: History = None,
    despite_verdict: DespiteVerdict = False,
    schedule_value: ScheduleValue = None,
) -> None:
    """Write a command as a table at a controller's sample time, checked for limits and slew."""
    refuse_inputs_as_outputs([out], [signal] if model is None else [signal, model])
    actuator = None if model is None else _operator(model, schedule_value)
    about = hyst.ModelDescription() if actuator is None else actuator.description
    values, name, unit = hyst.io.read_column(signal, column, **how)
    if actuator is not None:
        require_same_unit(unit, about.output_unit, "the wanted output")
    else:
        values, name, unit = _in_volts(values, name, unit, driver)
        about = hyst.ModelDescription(input_name=name, input_unit=unit)
    ends = None if limits is None else numbers(limits, "limits")
    if ends is not None and len(ends) != 2:
        raise hyst.InputError(f"--limits is {limits!r}; give the lowest and the highest drive")
    table = hyst.export.waveform(
        values,
        _sample_time(signal, rate, how),
        controller_rate=controller_rate,
        limits=None if ends is None else (ends[0], ends[1]),
        slew=slew,
        driver=None if bits is not None and driver is None else driver_for(driver, about),
        bits=bits,
        points=points,
        repeat=repeat,
        model=actuator,
        history=None if history is None else history_of(history),
        despite_verdict=despite_verdict,
    )
    hyst.io.write_columns(out, *table.columns(about.input_name, about.input_unit))
    _tell(table, about, repeat, out)
    show_files([out])


def _operator(file: Path, value: float | None) -> hyst.Operator:
    found = loaded_at(file, value)
    if not isinstance(found, hyst.Operator):
        raise hyst.InputError(f"{file} holds a {type(found).__name__}; give the file of a model")
    return found


def _in_volts(
    values: NDArray[np.float64], name: str, unit: str, typed: str | None
) -> tuple[NDArray[np.float64], str, str]:
    """Give a command with its name and unit, of a column that says codes the driver's volts."""
    driver = driver_of(typed) if says_codes(name, unit) else None
    return (values, name, unit) if driver is None else (driver.volts(values), "drive", driver.unit)


def _sample_time(file: Path, rate: float | None, how: dict[str, Any]) -> float:
    """Give the time from sample to sample of a file, as the user says or its time column."""
    if rate is not None:
        return 1.0 / as_positive(rate, "--rate", "samples per second")
    found = hyst.io.read_time_step(file, **how)
    if found is None:
        raise hyst.InputError(
            f"{file.name} has no time column; give --rate, its samples per second"
        )
    header, step = found
    if step is None:
        raise hyst.InputError(
            f"the time column {header!r} of {file.name} has no even steps in a known unit; give "
            "--rate, its samples per second"
        )
    return float(step)


def _tell(
    table: hyst.export.Waveform, about: hyst.ModelDescription, repeat: bool, out: Path
) -> None:
    volts = f" {about.input_unit}" if about.input_unit else ""
    lasts = table.u.size * table.dt
    rows = [
        ("points", f"{table.u.size}, {table.dt:.6g} s each, {lasts:.6g} s in all"),
        ("drive", f"{table.played.min():.6g} to {table.played.max():.6g}{volts}"),
        ("limits", f"{table.limits[0]:.6g} to {table.limits[1]:.6g}{volts}"),
        ("largest rate", f"{table.largest_rate:.6g}{volts} per second"),
    ]
    if table.codes is not None:
        off = f"at most {table.command_error.max_abs:.3g}{volts} off the drive wanted"
        rows.append(("codes", f"{table.codes.min()} to {table.codes.max()}, {off}"))
    if table.error is None:
        held = f"{table.command_error.held_max_abs:.3g}{volts} at most"
        rows.append(("off the command while held", held))
    rows += _errors(table, about, repeat)
    show_table(Table(f"Waveform {out.name}", ("", ""), tuple(rows)))
    for sentence in table.sentences:
        note(sentence)


def _errors(
    table: hyst.export.Waveform, about: hyst.ModelDescription, repeat: bool
) -> list[tuple[str, str]]:
    """Say by how much the output that the model predicts misses the wanted one."""
    if table.error is None or table.first_error is None:
        return []
    unit = f" {about.output_unit}" if about.output_unit else ""
    passes = [("error predicted", table.error)]
    if repeat:
        passes = [("first pass", table.first_error), ("steady cycle", table.error)]
    rows = []
    for name, error in passes:
        said = f"{error.rms:.3g}{unit} rms, {error.max_abs:.3g} at most"
        if error.held_max_abs != error.max_abs:
            said += f"; while held {error.held_rms:.3g} and {error.held_max_abs:.3g}"
        rows.append((name, said))
    return rows
