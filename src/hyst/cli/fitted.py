"""What the verbs that fit models share: records in, model, numbers, figures and a report out."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any

import typer

import hyst
from hyst.cli.console import show_table
from hyst.cli.driver_option import volts_of_record
from hyst.cli.exit_codes import DONE, UNFIT
from hyst.cli.reading_options import read_told

Data = Annotated[
    list[Path], typer.Argument(metavar="DATA", show_default=False, help="Measured records.")
]
Folder = Annotated[
    Path, typer.Option("-o", "--out", metavar="DIR", show_default=False, help="Where to write.")
]
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
NoFigures = Annotated[
    bool,
    typer.Option(
        "--no-figures",
        help="Write a page without figures, and without the sections that explain further ones.",
    ),
]


@dataclass(frozen=True)
class HowToRead:
    """Where the signals stand in the files.

    Parameters
    ----------
    columns
        Arguments of ``hyst.read_record``.
    validation_columns
        Columns of validation records that are called otherwise, by role; None where they are not.
    labels
        What input and output are to be called, with their units; None as in the file.
    driver
        Of the converter, where the input is in its codes; the records then are in volts.
    known_driver
        That of a model: for columns that say that they are codes.
    sources
        Where each record that was read comes from, in the order of reading.
    """

    columns: dict[str, Any]
    validation_columns: dict[str, str | None]
    labels: tuple[str | None, str | None]
    driver: hyst.Driver | None = None
    known_driver: hyst.Driver | None = None
    sources: list[str] = field(default_factory=list)

    def records(self, paths: Sequence[Path]) -> list[hyst.Record]:
        """Read the records to fit to.

        Raises
        ------
        InputError
            If several records are to have the output of one file.
        """
        if self.columns.get("output_file") is not None and len(paths) > 1:
            raise hyst.InputError(
                f"--output-file is the output of one record, and {len(paths)} are given; give one"
            )
        return [
            each
            for path in paths
            for each in self._named(path, _read(path, self.columns, self.labels, self._drivers))
        ]

    def validation(self, paths: Sequence[Path] | None) -> list[hyst.Record]:
        """Read the records to judge by; their input and output are in one file."""
        alike = self.columns | {"output_file": None}
        how = _otherwise(alike, self.validation_columns, paths)
        return [
            each
            for path in paths or []
            for each in self._named(path, _read_validation(path, how, self.labels, self._drivers))
        ]

    @property
    def _drivers(self) -> tuple[hyst.Driver | None, hyst.Driver | None]:
        return self.driver, self.known_driver

    def _named(self, path: Path, records: list[hyst.Record]) -> list[hyst.Record]:
        several = len(records) > 1
        self.sources.extend(
            f"{path}, table {number}" if several else str(path)
            for number in range(1, len(records) + 1)
        )
        return records


def _read(
    path: Path,
    how: dict[str, Any],
    labels: tuple[str | None, str | None],
    drivers: tuple[hyst.Driver | None, hyst.Driver | None],
) -> list[hyst.Record]:
    records = read_told(path, **how)
    try:
        records = tuple(volts_of_record(each, *drivers) for each in records)
    except hyst.InputError as refusal:
        raise hyst.InputError(f"{path.name}: {refusal}") from None
    return [_labelled(each, *labels, drivers[0]) for each in records]


def _otherwise(
    how: dict[str, Any], columns: dict[str, str | None], validate: Sequence[Path] | None
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
    path: Path,
    how: dict[str, Any],
    labels: tuple[str | None, str | None],
    drivers: tuple[hyst.Driver | None, hyst.Driver | None],
) -> list[hyst.Record]:
    try:
        return _read(path, how, labels, drivers)
    except hyst.InputError as error:
        if "has no column" not in str(error):
            raise
        raise hyst.InputError(
            f"{error}; columns of validation records are called as those of DATA unless "
            "--validate-input, --validate-output or --validate-time say otherwise"
        ) from error


def write_fitted(
    found: hyst.Identified,
    records: Sequence[hyst.Record],
    validation: Sequence[hyst.Record],
    folder: Path,
    sources: list[str],
    told: tuple[hyst.report.Section, ...] | None = (),
) -> tuple[Path, ...]:
    """Write model file, numbers, report and figures; these not where nothing is told of any."""
    sections = [] if told is None else [*hyst.report.dynamics_sections(found), *told]
    return hyst.report.write_report(
        found,
        records,
        validation,
        folder,
        sources=sources,
        sections=sections,
        figures=told is not None,
    )


def tell_fitted(found: hyst.Identified, records: Sequence[hyst.Record]) -> None:
    """Print how far to trust what was found, what it is, and how good it is."""
    print(hyst.report.verdict_lines(found.verdict))
    for sentence in hyst.report.in_short(found, tuple(records)):
        print(sentence)
    if found.candidates:
        show_table(hyst.report.candidates_table(found))
    show_table(hyst.report.metrics_table(found))
    by_record = hyst.report.per_record_table(found)
    if by_record.rows:
        show_table(by_record)
    show_table(hyst.report.parameters_table(found))
    if any(math.isnan(each) for each in found.standard_errors):
        print("(-: on a bound, or not determined by the records)")
    of_dynamics = hyst.report.dynamics_table(found)
    if of_dynamics.rows:
        show_table(of_dynamics)
    for sentence in found.undetermined:
        print(f"note: {sentence}")


def ended(found: hyst.Identified) -> int:
    """Give the exit code: whether a command should come from what was found."""
    return UNFIT if found.verdict.level == hyst.operators.verdict.UNFIT else DONE


def named_by_files(found: hyst.Identified, sources: Sequence[str]) -> hyst.Identified:
    """Give a result whose errors by record name the files, training records before others."""
    named = (
        replace(each, name=Path(source).name)
        for each, source in zip(found.per_record, sources, strict=False)
    )
    return replace(found, per_record=tuple(named))


def _labelled(
    record: hyst.Record,
    input_label: str | None,
    output_label: str | None,
    driver: hyst.Driver | None,
) -> hyst.Record:
    if input_label is not None:
        name, unit = hyst.io.split_unit(input_label)
        if driver is not None and hyst.signals.units_differ(unit, driver.unit):
            raise hyst.InputError(
                f"--input-label says {unit!r} and the driver gives {driver.unit!r}; say the unit "
                "of the volts, in the header of the driver's table"
            )
        unit = unit if driver is None else driver.unit
        record = replace(record, input_name=name, input_unit=unit)
    if output_label is not None:
        name, unit = hyst.io.split_unit(output_label)
        record = replace(record, output_name=name, output_unit=unit)
    return record
