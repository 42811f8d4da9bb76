"""hyst identify: from records to a model file and a report."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

import hyst
from hyst.cli.arguments import InputColumn, whole_or_auto
from hyst.cli.console import at_work, show_files, show_table


def identify(
    data: Annotated[
        list[Path], typer.Argument(metavar="DATA...", show_default=False, help="Measured records.")
    ],
    input_column: InputColumn,
    output_column: Annotated[
        str,
        typer.Option(
            "--output", metavar="COL", show_default=False, help="Column of the output, likewise."
        ),
    ],
    folder: Annotated[
        Path,
        typer.Option("-o", "--out", metavar="DIR", show_default=False, help="Where to write."),
    ],
    rate: Annotated[
        float | None, typer.Option(metavar="HZ", show_default=False, help="Samples per second.")
    ] = None,
    time: Annotated[
        str | None,
        typer.Option(metavar="COL", show_default=False, help="Or the column of time stamps."),
    ] = None,
    time_unit: Annotated[
        str | None,
        typer.Option(metavar="UNIT", show_default=False, help="Its unit: s, ms, us, ns, min, h."),
    ] = None,
    repair: Annotated[
        bool, typer.Option("--repair", help="Leave out bad rows, resample uneven time.")
    ] = False,
    family: Annotated[str, typer.Option(help="auto compares: linear, pi, gpi, mpi.")] = "auto",
    plays: Annotated[str, typer.Option(metavar="N|auto", help="Number of plays.")] = "auto",
    delay: Annotated[
        str, typer.Option(metavar="N|auto", help="Samples by which the output lags.")
    ] = "auto",
    start: Annotated[str, typer.Option(metavar="N|auto", help="First sample to use.")] = "auto",
    validate: Annotated[
        list[Path] | None,
        typer.Option(metavar="DATA", show_default=False, help="A record to judge by; repeatable."),
    ] = None,
    input_label: Annotated[
        str | None,
        typer.Option(
            metavar="LABEL", show_default=False, help='Call the input so, as "drive [V]".'
        ),
    ] = None,
    output_label: Annotated[
        str | None,
        typer.Option(metavar="LABEL", show_default=False, help="Call the output so, likewise."),
    ] = None,
    allow_unconverged: Annotated[
        bool, typer.Option("--allow-unconverged", help="Accept a fit that did not converge.")
    ] = False,
) -> None:
    """Identify a model from measured records, and write model, numbers, figures and a report."""
    hyst.files.require_folder(folder)

    def read(path: Path) -> hyst.Record:
        record = hyst.read_record(
            path,
            input=input_column,
            output=output_column,
            time=time,
            rate=rate,
            time_unit=time_unit,
            repair=repair,
        )
        return _labelled(record, input_label, output_label)

    with at_work("identifying") as say:
        say("reading")
        records = [read(path) for path in data]
        validation = [read(path) for path in validate or []]
        found = hyst.identify(
            records,
            family=family,
            plays=whole_or_auto(plays, "plays"),
            delay=whole_or_auto(delay, "delay"),
            start=whole_or_auto(start, "start"),
            validation=validation,
            allow_unconverged=allow_unconverged,
            progress=say,
        )
        say("report")
        sources = [str(path) for path in (*data, *(validate or []))]
        files = hyst.report.write_report(found, records, validation, folder, sources=sources)
    for sentence in hyst.report.in_short(found, tuple(records)):
        print(sentence)
    if found.candidates:
        show_table(hyst.report.candidates_table(found))
    show_table(hyst.report.metrics_table(found))
    show_table(hyst.report.parameters_table(found))
    for sentence in found.undetermined:
        print(f"undetermined: {sentence}")
    show_files(files)


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
