"""hyst identify: from records to a model file and a report."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

import hyst
from hyst._files import require_folder
from hyst.cli.arguments import InputColumn, numbers, whole_or_auto
from hyst.cli.console import at_work, show_files, show_table
from hyst.cli.relevant_options import refuse_irrelevant

Data = Annotated[
    list[Path], typer.Argument(metavar="DATA", show_default=False, help="Measured records.")
]
OutputColumn = Annotated[
    str,
    typer.Option("--output", metavar="COL", show_default=False, help="Column of the output."),
]
Folder = Annotated[
    Path, typer.Option("-o", "--out", metavar="DIR", show_default=False, help="Where to write.")
]
Rate = Annotated[
    float | None, typer.Option(metavar="HZ", show_default=False, help="Samples per second.")
]
TimeColumn = Annotated[
    str | None,
    typer.Option(metavar="COL", show_default=False, help="Or the column of time stamps."),
]
TimeUnit = Annotated[
    str | None,
    typer.Option(metavar="UNIT", show_default=False, help="Its unit: s, ms, us, ns, min or h."),
]
Repair = Annotated[
    bool, typer.Option("--repair", help="Leave out bad rows and resample uneven time.")
]
Family = Annotated[
    str,
    typer.Option(
        help="linear, pi, gpi, mpi; auto compares them. Or rdpi, ramberg-osgood, hammerstein; "
        "or a,b."
    ),
]
Memory = Annotated[
    str, typer.Option(help="Of ramberg-osgood: masing (loops close) or last-reversal (drifts).")
]
Regression = Annotated[
    str, typer.Option(help="Of ramberg-osgood: fit the output, or its slope over the input.")
]
Plays = Annotated[str, typer.Option(metavar="N|auto", help="Number of plays.")]
Knots = Annotated[int, typer.Option(help="Knots of the map of gpi and mpi.")]
Spacing = Annotated[str, typer.Option(help="Of rdpi: radii even or free.")]
RecordWeights = Annotated[
    str,
    typer.Option(
        metavar="WEIGHTS", help="Of rdpi: equal, hysteresis, or a number a record, as 1,1.56,2."
    ),
]
Weights = Annotated[
    str, typer.Option(help="auto, non-negative, or invertible: negative where the inverse allows.")
]
Delay = Annotated[str, typer.Option(metavar="N|auto", help="Samples by which the output lags.")]
Start = Annotated[str, typer.Option(metavar="N|auto", help="First sample to use.")]
Hysteresis = Annotated[
    str, typer.Option(help="Of hammerstein: linear, pi, gpi, mpi or ramberg-osgood.")
]
FirOrder = Annotated[
    str, typer.Option(metavar="N|auto", help="Of hammerstein: last lag of the impulse response.")
]
StateOrder = Annotated[
    str, typer.Option(metavar="N|auto", help="Of hammerstein: order of the linear dynamics.")
]
Period = Annotated[
    int | None,
    typer.Option(
        metavar="N",
        show_default=False,
        help="Of hammerstein: samples of a period of the drive; all but the first are averaged.",
    ),
]
SignalToNoise = Annotated[
    float, typer.Option(help="Of ramberg-osgood with slopes: what a step must be over its noise.")
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

_PLAYS, _MAPS = ("pi", "gpi", "mpi"), ("gpi", "mpi")
_DYNAMICS = ("hysteresis", "fir_order", "state_order", "period")
# Which families, and which hysteresis of hammerstein, take an option that not all take.
_BY_FAMILY = {
    "plays": (*_PLAYS, "rdpi", "hammerstein"),
    "knots": (*_MAPS, "hammerstein"),
    "weights": (*_PLAYS, "hammerstein"),
    **dict.fromkeys(("memory", "regression", "signal_to_noise"), ("ramberg-osgood",)),
    **dict.fromkeys(("spacing", "record_weights"), ("rdpi",)),
    **dict.fromkeys(_DYNAMICS, ("hammerstein",)),
}
_BY_HYSTERESIS = {"plays": _PLAYS, "knots": _MAPS, "weights": ("pi", "mpi")}


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
    plays: Plays = "auto",
    knots: Knots = 6,
    weights: Weights = "auto",
    memory: Memory = "masing",
    regression: Regression = "output",
    signal_to_noise: SignalToNoise = 3.0,
    spacing: Spacing = "even",
    record_weights: RecordWeights = "equal",
    delay: Delay = "auto",
    start: Start = "auto",
    hysteresis: Hysteresis = "mpi",
    fir_order: FirOrder = "auto",
    state_order: StateOrder = "auto",
    period: Period = None,
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
    _refuse_what_is_not_used(context, family, hysteresis, regression)
    how_to_read = {"input": input_column, "output": output_column, "time": time, "rate": rate}
    how_to_read |= {"time_unit": time_unit, "repair": repair}
    columns = {"input": validate_input, "output": validate_output, "time": validate_time}
    how_to_validate = _otherwise(how_to_read, columns, validate)
    labels = (input_label, output_label)
    counts = {"plays": plays, "delay": delay, "start": start}
    options = _whole_or_auto(counts | {"fir_order": fir_order, "state_order": state_order})
    options |= {"memory": memory, "regression": regression, "signal_to_noise": signal_to_noise}
    options |= {"knots": knots, "weights": weights, "hysteresis": hysteresis, "period": period}
    options |= {"spacing": spacing, "record_weights": _numbers_or_word(record_weights)}
    options["allow_unconverged"] = allow_unconverged
    with at_work("identifying") as say:
        say("reading")
        measured = [_read(path, how_to_read, labels) for path in data]
        records = _averaged(measured, period)
        validation = [_read_validation(path, how_to_validate, labels) for path in validate or []]
        found = hyst.identify(
            records, family=family, validation=validation, progress=say, **options
        )
        say("report")
        told = hyst.report.distortion_sections(measured, period)
        files = _write(found, records, validation, folder, [*data, *(validate or [])], told)
    _tell(found, records)
    show_files(files)


def _refuse_what_is_not_used(
    context: typer.Context, family: str, hysteresis: str, regression: str
) -> None:
    """Refuse options of other families; what is unknown is refused where it is looked up."""
    families = [each.strip() for each in family.split(",")]
    if family == "auto":
        families = ["linear", *_PLAYS]
    if set(families) <= {"linear", *(each for those in _BY_FAMILY.values() for each in those)}:
        refuse_irrelevant(context, _BY_FAMILY, families, "--family")
    if families == ["hammerstein"] and hysteresis in ("linear", "ramberg-osgood", *_PLAYS):
        refuse_irrelevant(context, _BY_HYSTERESIS, [hysteresis], "--hysteresis")
    if regression == "output":
        refuse_irrelevant(context, {"signal_to_noise": ["slope"]}, [regression], "--regression")


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


def _averaged(records: list[hyst.Record], period: int | None) -> list[hyst.Record]:
    """Give what is identified from; averaging once more, as identify does, changes nothing."""
    if period is None:
        return records
    return [
        hyst.identification.families.hammerstein.average_periods(each, period) for each in records
    ]


def _write(
    found: hyst.Identified,
    records: list[hyst.Record],
    validation: list[hyst.Record],
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


def _whole_or_auto(counts: dict[str, str]) -> dict[str, Any]:
    return {name: whole_or_auto(text, name.replace("_", "-")) for name, text in counts.items()}


def _numbers_or_word(text: str) -> str | list[float]:
    return numbers(text, "record-weights") if "," in text else text


def _tell(found: hyst.Identified, records: list[hyst.Record]) -> None:
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
