"""Arguments that several verbs take, and how their text is read."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import typer

import hyst
from hyst.checks.numbers import as_positive
from hyst.cli.console import note

ModelFile = Annotated[
    Path,
    typer.Argument(metavar="MODEL", show_default=False, help="Model file, as identify writes."),
]
InputColumn = Annotated[
    str,
    typer.Option(
        "--input",
        metavar="COL",
        show_default=False,
        help="Column of the input: name or index from 0.",
    ),
]
OutputColumn = Annotated[
    str,
    typer.Option("--output", metavar="COL", show_default=False, help="Column of the output."),
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
    bool,
    typer.Option(
        "--repair",
        help="Leave out a few bad rows, and resample uneven time; what was done is told.",
    ),
]
LongestGap = Annotated[
    int,
    typer.Option(metavar="N", help="Samples in a row that --repair may leave out or fill in."),
]
DeadBand = Annotated[
    float | None,
    typer.Option(
        metavar="X",
        show_default=False,
        help="Swings of the input up to this size are no reversals; from its noise by default.",
    ),
]
TableNumber = Annotated[
    str | None,
    typer.Option(
        "--table",
        metavar="N|all",
        show_default=False,
        help="Which of several tables below each other in a text file; all: each is a record.",
    ),
]
FileFormat = Annotated[
    str | None,
    typer.Option(
        "--format",
        metavar="FORMAT",
        show_default=False,
        help=f"Of the data, where neither content nor suffix tells: {', '.join(hyst.io.FORMATS)}.",
    ),
]

Resample = Annotated[
    bool,
    typer.Option(
        "--resample", help="Bring two signals stamped apart to one raster; the cost is told."
    ),
]
HoldInput = Annotated[
    bool,
    typer.Option("--hold-input", help="In that, let the input keep a value until its next stamp."),
]
InputTime = Annotated[
    str | None,
    typer.Option(metavar="COL", show_default=False, help="Stamps of the input, if not --time."),
]
OutputTime = Annotated[
    str | None,
    typer.Option(metavar="COL", show_default=False, help="Stamps of the output, likewise."),
]
OutputFile = Annotated[
    Path | None,
    typer.Option(metavar="FILE", show_default=False, help="File of the output, if another one."),
]
MaxSamples = Annotated[
    int, typer.Option(metavar="N", min=1, help="Most numbers to read of a file.")
]
MOST_SAMPLES = 100_000_000

SampleRate = Annotated[
    float | None,
    typer.Option(
        "--rate",
        metavar="HZ",
        show_default=False,
        help="Samples of the file per second, to check a model that depends on the rate.",
    ),
]

DespiteVerdict = Annotated[
    bool,
    typer.Option("--despite-verdict", help="Go on with a model whose verdict is unfit."),
]

_STAMPS_ROUNDED = 1e-3


# What verbs call otherwise than read_record does.
_CALLED = {"input_column": "input", "output_column": "output", "file_format": "format"}
_READING = (
    *("input_column", "output_column", "time", "rate", "time_unit", "repair", "longest_gap"),
    *("dead_band", "table", "file_format", "resample", "hold_input", "input_time"),
    *("output_time", "output_file", "max_samples"),
)


def reading_options(context: typer.Context) -> dict[str, Any]:
    """Give what a verb was told about reading, as ``read_told`` takes it."""
    return {_CALLED.get(name, name): context.params[name] for name in _READING}


def read_told(path: Path, *, table: str | None = None, **how: Any) -> tuple[hyst.Record, ...]:
    """Read the record of a file, or with the table ``all`` those of all its tables.

    What was found out, left out or repaired is told.
    """
    if table == "all":
        records = hyst.io.read_records(path, **how)
    else:
        records = (hyst.read_record(path, table=_table_number(table), **how),)
    for number, record in enumerate(records, 1):
        which = f", table {number}" if len(records) > 1 else ""
        for sentence in record.notes:
            note(f"{path.name}{which}: {sentence}")
    return records


def _table_number(text: str | None) -> int | None:
    try:
        return None if text is None else int(text)
    except ValueError:
        raise hyst.InputError(f"--table is {text!r}; give a whole number or all") from None


def load_operator(path: Path) -> hyst.operators.Operator:
    """Read a model file that holds an operator, and nothing else."""
    found = hyst.load(path)
    if not isinstance(found, hyst.operators.Operator):
        raise hyst.InputError(
            f"{path} holds a {type(found).__name__}, not one input's model; give a model file, as "
            "hyst identify writes"
        )
    return found


def whole_or_auto(text: str, name: str) -> int | Literal["auto"]:
    """Read a whole number or the word auto."""
    if text == "auto":
        return "auto"
    try:
        return int(text)
    except ValueError:
        raise hyst.InputError(f"--{name} is {text!r}; give a whole number or auto") from None


def number_or_auto(text: str, name: str) -> float | Literal["auto"]:
    """Read a number, a whole one as such, or the word auto."""
    if text == "auto":
        return "auto"
    try:
        value = float(text)
    except ValueError:
        raise hyst.InputError(f"--{name} is {text!r}; give a number or auto") from None
    return int(value) if value.is_integer() else value


def numbers(text: str, name: str) -> list[float]:
    """Read numbers with commas between them."""
    try:
        return [float(each) for each in text.split(",")]
    except ValueError:
        raise hyst.InputError(
            f"--{name} is {text!r}; give numbers with commas between them, as 0,3.6"
        ) from None


def sample_time_known(
    model: hyst.operators.Operator, file: Path, rate: float | None, what: str
) -> bool:
    """Refuse a file of another sample time than the model's; say if the file or --rate tells."""
    if rate is not None:
        model.require_sample_time(1.0 / as_positive(rate, "--rate", "samples per second"), what)
        return True
    if model.dt is None:
        return True
    found = hyst.io.read_time_step(file)
    if found is None:
        return False
    header, step = found
    if step is None:
        raise hyst.InputError(
            f"the time column {header!r} of {file.name} has no even steps in a known unit, so its "
            "sample time cannot be compared with the model's; give --rate"
        )
    # Printed stamps are rounded.
    if abs(step - model.dt) > _STAMPS_ROUNDED * model.dt:
        model.require_sample_time(step, f"{what} by its column {header!r}")
    return True


def require_same_unit(unit: str, model_unit: str, what: str) -> None:
    """Refuse a signal in another unit than the model's; one that says none is believed."""
    if hyst.signals.units_differ(unit, model_unit):
        raise hyst.InputError(
            f"{what} is in {unit!r} but the model's in {model_unit!r}; hyst converts no units, so "
            "convert the column, or correct its header"
        )
