"""hyst identify: from records to a model file and a report."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

import hyst
from hyst._files import require_folder
from hyst.cli.arguments import (
    InputColumn,
    OutputColumn,
    Rate,
    Repair,
    TimeColumn,
    TimeUnit,
    whole_or_auto,
)
from hyst.cli.console import at_work, show_files, show_table
from hyst.cli.family_options import options_given

Data = Annotated[
    list[Path], typer.Argument(metavar="DATA", show_default=False, help="Measured records.")
]
Folder = Annotated[
    Path, typer.Option("-o", "--out", metavar="DIR", show_default=False, help="Where to write.")
]
Family = Annotated[str, typer.Option(help="Of the model.")]  # the registry explains it
Delay = Annotated[str, typer.Option(metavar="N|auto", help="Samples by which the output lags.")]
Start = Annotated[str, typer.Option(metavar="N|auto", help="First sample to use.")]
Validate = Annotated[
    list[Path] | None,
    typer.Option(metavar="DATA", show_default=False, help="A record to judge by; repeatable."),
]
ValidateInput = Annotated[
    str | None,
    typer.Option(metavar="COL", show_default=False, help="Their input, where it is called other."),
]
ValidateOutput = Annotated[
    str | None, typer.Option(metavar="COL", show_default=False, help="Their output, likewise.")
]
ValidateTime = Annotated[
    str | None, typer.Option(metavar="COL", show_default=False, help="Their time, likewise.")
]
InputLabel = Annotated[
    str | None,
    typer.Option(metavar="LABEL", show_default=False, help='Call the input so, as "drive [V]".'),
]
OutputLabel = Annotated[
    str | None, typer.Option(metavar="LABEL", show_default=False, help="Call the output so.")
]
AllowUnconverged = Annotated[
    bool, typer.Option("--allow-unconverged", help="Accept a fit that did not converge.")
]


def identify(
    context: typer.Context,
    data: Data,
    input_column: InputColumn,
    output_column: OutputColumn,
    folder: Folder,
    rate: Rate = None,
    time: TimeColumn = None,
    time_unit: TimeUnit = None,
    repair: Repair = False,
    family: Family = "auto",
    delay: Delay = "auto",
    start: Start = "auto",
    validate: Validate = None,
    validate_input: ValidateInput = None,
    validate_output: ValidateOutput = None,
    validate_time: ValidateTime = None,
    input_label: InputLabel = None,
    output_label: OutputLabel = None,
    allow_unconverged: AllowUnconverged = False,
) -> None:
    """Identify a model from measured records, and write model, numbers, figures and a report."""
    require_folder(folder)
    options = options_given(context, family)
    chosen = hyst.identification.chosen_families(family, options)
    lag, first = whole_or_auto(delay, "delay"), whole_or_auto(start, "start")
    how_to_read = {"input": input_column, "output": output_column, "time": time, "rate": rate}
    how_to_read |= {"time_unit": time_unit, "repair": repair}
    columns = {"input": validate_input, "output": validate_output, "time": validate_time}
    how_to_validate = _otherwise(how_to_read, columns, validate)
    labels = (input_label, output_label)
    with at_work("identifying") as say:
        say("reading")
        measured = [_read(path, how_to_read, labels) for path in data]
        validation = [_read_validation(path, how_to_validate, labels) for path in validate or []]
        found = hyst.identify(
            measured,
            family=family,
            delay=lag,
            start=first,
            validation=validation,
            allow_unconverged=allow_unconverged,
            progress=say,
            **options,
        )
        say("report")
        used = next(each for each in chosen if each.name == found.family)
        records = used.records_to_use(tuple(measured), first)[0].records
        told = hyst.report.distortion_sections(measured, options.get("period"))
        files = _write(found, records, validation, folder, [*data, *(validate or [])], told)
    _tell(found, records)
    show_files(files)


def _read(path: Path, how: dict[str, Any], labels: tuple[str | None, str | None]) -> hyst.Record:
    return _labelled(hyst.read_record(path, **how), *labels)


def _otherwise(
    how: dict[str, Any], columns: dict[str, str | None], validate: list[Path] | None
) -> dict[str, Any]:
    """Read validation records like the others, but from their own columns where those are named."""
    named = {role: column for role, column in columns.items() if column is not None}
    if named and not validate:
        raise hyst.InputError(
            f"--validate-{min(named)} names a column of validation records, and there are none; "
            "give --validate too"
        )
    return how | named


def _read_validation(
    path: Path, how: dict[str, Any], labels: tuple[str | None, str | None]
) -> hyst.Record:
    try:
        return _read(path, how, labels)
    except hyst.InputError as error:
        if "has no column" not in str(error):
            raise
        raise hyst.InputError(
            f"{error}; columns of validation records are called as those of DATA unless "
            "--validate-input, --validate-output or --validate-time say otherwise"
        ) from error


def _write(
    found: hyst.Identified,
    records: Sequence[hyst.Record],
    validation: Sequence[hyst.Record],
    folder: Path,
    sources: list[Path],
    told: tuple[hyst.report.Section, ...],
) -> tuple[Path, ...]:
    return hyst.report.write_report(
        found,
        records,
        validation,
        folder,
        sources=[str(path) for path in sources],
        sections=[*hyst.report.dynamics_sections(found), *told],
    )


def _tell(found: hyst.Identified, records: Sequence[hyst.Record]) -> None:
    for sentence in hyst.report.in_short(found, tuple(records)):
        print(sentence)
    if found.candidates:
        show_table(hyst.report.candidates_table(found))
    show_table(hyst.report.metrics_table(found))
    show_table(hyst.report.parameters_table(found))
    for sentence in found.undetermined:
        print(f"note: {sentence}")


def _labelled(
    record: hyst.Record, input_label: str | None, output_label: str | None
) -> hyst.Record:
    if input_label is not None:
        name, unit = hyst.io.split_unit(input_label)
        record = replace(record, input_name=name, input_unit=unit)
    if output_label is not None:
        name, unit = hyst.io.split_unit(output_label)
        record = replace(record, output_name=name, output_unit=unit)
    return record
