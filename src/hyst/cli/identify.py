"""hyst identify: from records to a model file and a report."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any, Literal

import typer

import hyst
from hyst._files import require_folder
from hyst.cli.arguments import (
    number_or_auto,
    whole_auto_or_none,
    whole_or_auto,
)
from hyst.cli.console import at_work, show_files
from hyst.cli.driver_option import DriverOfInput, driver_of
from hyst.cli.family_options import options_given
from hyst.cli.fitted import (
    AllowUnconverged,
    Data,
    Folder,
    HowToRead,
    InputLabel,
    NoFigures,
    OutputLabel,
    Validate,
    ValidateInput,
    ValidateOutput,
    ValidateTime,
    ended,
    named_by_files,
    tell_fitted,
    write_fitted,
)
from hyst.cli.in_file import FileToKeep, InFile, shown
from hyst.cli.reading_options import reads_records
from hyst.cli.scheduled import (
    About,
    Schedule,
    ScheduleName,
    ScheduleUnit,
    ValidateSchedule,
    identify_over,
)

Family = Annotated[str, typer.Option(help="Of the model.")]  # the registry explains it
Delay = Annotated[
    str,
    typer.Option(
        metavar="X|auto",
        help="Samples by which the output lags; parts of one, or negative where it is ahead.",
    ),
]
Lag = Annotated[
    str,
    typer.Option(
        metavar="SECONDS|auto|none",
        help="Time constant of a first-order lag of the drive, as of an amplifier, in the model.",
    ),
]
LeaveDisturbances = Annotated[
    bool,
    typer.Option(
        "--leave-disturbances", help="Take neither drift nor foreign sines out of the output."
    ),
]
Creep = Annotated[
    str,
    typer.Option(
        metavar="N|auto|none",
        help="Number of lags that creep behind the hysteresis; auto: as many as the records show.",
    ),
]
Start = Annotated[str, typer.Option(metavar="N|auto", help="First sample to use.")]


@reads_records
def identify(
    context: typer.Context,
    data: Data,
    folder: Folder,
    how: dict[str, Any],
    family: Family = "auto",
    delay: Delay = "auto",
    start: Start = "auto",
    lag: Lag = "none",
    leave_disturbances: LeaveDisturbances = False,
    creep: Creep = "auto",
    validate: Validate = None,
    validate_input: ValidateInput = None,
    validate_output: ValidateOutput = None,
    validate_time: ValidateTime = None,
    input_label: InputLabel = None,
    output_label: OutputLabel = None,
    driver: DriverOfInput = None,
    allow_unconverged: AllowUnconverged = False,
    schedule: Schedule = None,
    schedule_name: ScheduleName = None,
    schedule_unit: ScheduleUnit = None,
    validate_schedule: ValidateSchedule = None,
    in_file: InFile = "auto",
    no_figures: NoFigures = False,
) -> int:
    """Identify a model from measured records, and write model, numbers, figures and a report."""
    require_folder(folder)
    options = options_given(context, family)
    named = hyst.identification.chosen_families(family, options)
    chosen = named + hyst.identification.families_in_reserve(family, options)
    lags, first = whole_auto_or_none(creep, "creep"), whole_or_auto(start, "start")
    late = number_or_auto(delay, "delay")
    time_constant = None if lag == "none" else number_or_auto(lag, "lag", " or none")
    others = {"input": validate_input, "output": validate_output, "time": validate_time}
    files = HowToRead(how, others, (input_label, output_label), driver_of(driver))
    drift = False if leave_disturbances else "auto"
    asked = {"family": family, "delay": late, "start": first, "drift": drift, **options}
    asked["allow_unconverged"] = allow_unconverged
    about = About(schedule, schedule_name, schedule_unit, validate_schedule)
    alone = {"--lag": time_constant is not None, "--creep": creep not in ("auto", "none")}
    if about.is_given(alone | {"--in-file": in_file == "yes", "--no-figures": no_figures}):
        return identify_over(data, validate, folder, files, about, asked)
    asked |= {"creep": lags, "lag": time_constant}
    labelled = {"--input-label": input_label, "--output-label": output_label}
    with at_work("identifying") as say:
        say("reading")
        kept = FileToKeep(data, how, {"--driver": driver, **labelled}).opened(in_file)
        measured = files.records(data) if kept is None else []
        files.sources.extend([] if kept is None else [str(data[0])])
        validation = files.validation(validate)
        found = hyst.identify(kept or measured, validation=validation, progress=say, **asked)
        say("report")
        measured = shown(found, measured, kept)
        found = hyst.identification.with_driver(named_by_files(found, files.sources), files.driver)
        records = _records_used(found, chosen, measured, first)
        told = None if no_figures else _told(measured, options.get("period"))
        written = write_fitted(found, records, validation, folder, files.sources, told)
    tell_fitted(found, records)
    show_files(written)
    return ended(found)


def _told(measured: Sequence[hyst.Record], period: int | None) -> tuple[hyst.report.Section, ...]:
    return () if period is None else hyst.report.distortion_sections(measured, period)


def _records_used(
    found: hyst.Identified,
    chosen: Sequence[hyst.identification.families.family.Family],
    measured: Sequence[hyst.Record],
    start: int | Literal["auto"],
) -> tuple[hyst.Record, ...]:
    """Give the records as the family that was chosen took them, as averages of periods."""
    used = next(each for each in chosen if each.name == found.family)
    return used.records_to_use(tuple(measured), start)[0].records
