"""hyst fleet: many actuators, one table, one model each, the odd ones named."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

import hyst
from hyst.cli.arguments import (
    load_operator,
    number_or_auto,
    refuse_inputs_as_outputs,
    whole_auto_or_none,
    whole_or_auto,
)
from hyst.cli.console import at_work, note, show_files, show_table
from hyst.cli.exit_codes import DONE, UNFIT
from hyst.cli.family_options import options_given
from hyst.cli.fitted import Folder
from hyst.cli.fleet.devices import devices_of_files, devices_of_table, limits_typed
from hyst.cli.identify import Family, LeaveDisturbances
from hyst.cli.reading_options import may_read_records

Records = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="RECORDS", show_default=False, help="Files, or patterns as 'RECORDS/*.csv'."
    ),
]
Devices = Annotated[
    Path | None,
    typer.Option(
        metavar="TABLE",
        show_default=False,
        help="In their place a CSV or Parquet with the columns file, identifier, input, output, "
        "rate or time, and limits as 'max rms_percent'.",
    ),
]
Limit = Annotated[
    list[str] | None,
    typer.Option(
        metavar="LIMIT",
        show_default=False,
        help="A production limit, as 'rms_percent<0.5' or '0.9<gain<1.1'; repeatable.",
    ),
]
LimitsFile = Annotated[
    Path | None,
    typer.Option(
        "--limits",
        metavar="FILE",
        show_default=False,
        help="Limits in TOML or JSON, by quantity: min, max or both.",
    ),
]
Shape = Annotated[
    str | None,
    typer.Option(
        metavar="MODEL|DIR|shared",
        show_default=False,
        help="Shape that all devices share: estimated from this fleet (shared), of a fleet in a "
        "folder that was, or of a model.",
    ),
]
Scheduler = Annotated[
    str,
    typer.Option(
        metavar="WHERE",
        help="processes, threads, dask (a cluster made for this run), or the address of a Dask "
        "scheduler, as tcp://HOST:8786.",
    ),
]
Workers = Annotated[
    int | None,
    typer.Option(metavar="N", min=1, show_default="one a core", help="Processes or threads."),
]
Chosen = Annotated[
    str | None,
    typer.Option(
        metavar="X|auto",
        show_default="chosen for all",
        help="Samples by which outputs lag; auto: each device finds its own.",
    ),
]
Creeping = Annotated[
    str | None,
    typer.Option(
        metavar="N|auto|none",
        show_default="chosen for all",
        help="Lags that creep behind the hysteresis; auto: each device finds its own.",
    ),
]
Start = Annotated[str, typer.Option(metavar="N|auto", help="First sample to use.")]
NoFigures = Annotated[bool, typer.Option("--no-figures", help="Write a page without figures.")]
Force = Annotated[
    bool,
    typer.Option("--force", help="Begin anew in a folder that holds a fleet with other options."),
]

MOST_TOLD = 20
"""Odd devices and failures on the terminal; all are in the table."""


@may_read_records
def fleet(
    context: typer.Context,
    folder: Folder,
    how: dict[str, Any],
    records: Records = None,
    devices: Devices = None,
    limit: Limit = None,
    limits: LimitsFile = None,
    family: Family = "auto",
    delay: Chosen = None,
    creep: Creeping = None,
    start: Start = "auto",
    shape: Shape = None,
    leave_disturbances: LeaveDisturbances = False,
    scheduler: Scheduler = "processes",
    workers: Workers = None,
    no_figures: NoFigures = False,
    force: Force = False,
) -> int:
    """Identify one model for each of many records, and name the odd ones.

    What is done in DIR already, of the same files with the same options, is not done again.
    """
    asked: dict[str, Any] = {"family": family, **options_given(context, family)}
    if delay is not None:
        asked["delay"] = number_or_auto(delay, "delay")
    if creep is not None:
        asked["creep"] = whole_auto_or_none(creep, "creep")
    if start != "auto":
        asked["start"] = whole_or_auto(start, "start")
    if leave_disturbances:
        asked["drift"] = False
    common = limits_typed(limit, limits)
    sources = _sources(records, devices, how)
    outputs = [folder / name for name in ("fleet.csv", "fleet.html")]
    refuse_inputs_as_outputs(outputs, [Path(each.file) for each in sources])
    with at_work("fleet") as say:
        found = hyst.fleet.identify(
            sources,
            shape=_shape(shape),
            scheduler=scheduler,
            limits=common,
            folder=folder,
            force=force,
            workers=workers,
            progress=say,
            **asked,
        )
        say("page")
        written = hyst.report.write_fleet_page(found, folder, figures=not no_figures)
    _tell(found)
    tables = [each for name in ("fleet.csv", "fleet.parquet") if (each := folder / name).exists()]
    show_files([*written, *tables])
    return ended(found)


def _sources(records: list[str] | None, devices: Path | None, how: dict[str, Any]) -> list[Any]:
    if bool(records) == (devices is not None):
        raise hyst.InputError("give the records of the fleet, or a table of them with --devices")
    if how["output_file"] is not None or how["table"] == "all":
        raise hyst.InputError(
            "a device has one record: --output-file and --table all are for hyst identify"
        )
    table = how["table"]
    read = {**how, "table": None if table is None else _table_number(table)}
    if devices is not None:
        return devices_of_table(devices, read)
    return devices_of_files(records or (), read)


def _shape(text: str | None) -> Any:
    if text is None or text == "shared":
        return text
    if Path(text).is_dir():
        return hyst.fleet.shape_of_folder(Path(text))
    return load_operator(Path(text))


def _table_number(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise hyst.InputError(f"--table is {text!r}; give a whole number") from None


def _tell(found: hyst.fleet.Fleet) -> None:
    for sentence in found.sentences():
        print(sentence)
    for table in (
        hyst.report.broken_limits_table(found),
        hyst.report.odd_devices_table(found),
        hyst.report.failed_devices_table(found),
    ):
        if table.rows:
            more = len(table.rows) - MOST_TOLD
            show_table(hyst.report.Table(table.title, table.header, table.rows[:MOST_TOLD]))
            if more > 0:
                note(f"{more} more are in the table")
    show_table(hyst.report.fleet_numbers_table(found))


def ended(found: hyst.fleet.Fleet) -> int:
    """Give the exit code: whether every device has a model that is fit and keeps its limits."""
    told = found.counts()
    return UNFIT if told["failed"] or told["unfit"] or told["fail"] else DONE
