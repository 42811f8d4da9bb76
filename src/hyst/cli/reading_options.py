"""How verbs are told to read files: one set of options for all of them."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, get_type_hints

import typer

import hyst
from hyst.cli.console import note

_INPUT = typer.Option(
    "--input",
    metavar="COL",
    show_default=False,
    help="Column of the input: name or index from 0.",
)
_OUTPUT = typer.Option("--output", metavar="COL", show_default=False, help="Column of the output.")
InputColumn = Annotated[str, _INPUT]
OutputColumn = Annotated[str, _OUTPUT]
Rate = Annotated[
    float | None, typer.Option(metavar="HZ", show_default=False, help="Samples per second.")
]
TimeColumn = Annotated[
    str | None,
    typer.Option(metavar="COL", show_default=False, help="Or the column of time stamps."),
]
TimeUnit = Annotated[
    str | None,
    typer.Option(metavar="UNIT", show_default=False, help="Its unit: s, ms, us, ns, min, h, days."),
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
OneTable = Annotated[
    int | None,
    typer.Option(
        "--table",
        metavar="N",
        show_default=False,
        help="Which of several tables below each other in a text file.",
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

_NEEDED = inspect.Parameter.empty
_MOST_SAMPLES = 100_000_000
_HOW = "how"
# What a record is read with: names in read_record, or on the command line where they would be
# words of Python, with annotation and default.
_OF_A_RECORD: dict[str, tuple[Any, Any]] = {
    "input_column": (InputColumn, _NEEDED),
    "output_column": (OutputColumn, _NEEDED),
    "rate": (Rate, None),
    "time": (TimeColumn, None),
    "time_unit": (TimeUnit, None),
    "repair": (Repair, False),
    "longest_gap": (LongestGap, hyst.io.LONGEST_GAP),
    "dead_band": (DeadBand, None),
    "table": (TableNumber, None),
    "file_format": (FileFormat, None),
    "resample": (Resample, False),
    "hold_input": (HoldInput, False),
    "input_time": (InputTime, None),
    "output_time": (OutputTime, None),
    "output_file": (OutputFile, None),
    "max_samples": (MaxSamples, _MOST_SAMPLES),
}
_OF_A_FILE: dict[str, tuple[Any, Any]] = {
    "table": (OneTable, None),
    "file_format": (FileFormat, None),
    "max_samples": (MaxSamples, _MOST_SAMPLES),
}
# Of repetitions of a motion, of which there are none before the first.
_CALLED = {"input_column": "input", "output_column": "output", "file_format": "format"}

Verb = Callable[..., Any]


def reads_records(verb: Verb) -> Verb:
    """Give a verb the options of reading records; it gets them as ``how``, for ``read_told``."""
    return with_options(verb, _OF_A_RECORD)


def may_read_records(verb: Verb) -> Verb:
    """Give a verb the same options where files may be left out, and so their columns too."""
    columns = {
        "input_column": (Annotated[str | None, _INPUT], None),
        "output_column": (Annotated[str | None, _OUTPUT], None),
    }
    return with_options(verb, _OF_A_RECORD | columns)


def reads_columns(verb: Verb) -> Verb:
    """Give a verb the options of reading single columns, as ``how`` for ``hyst.io.read_column``."""
    return with_options(verb, _OF_A_FILE)


def with_options(verb: Verb, options: dict[str, tuple[Any, Any]], parameter: str = _HOW) -> Verb:
    """Put options in the place of a parameter of a verb, which gets them as a dictionary.

    Parameters
    ----------
    verb
        To be told.
    options
        Annotation and default by name.
    parameter
        Whose place they take.
    """
    hints = get_type_hints(verb, include_extras=True)

    @functools.wraps(verb)
    def told(**values: Any) -> Any:
        taken = {_CALLED.get(name, name): values.pop(name) for name in options}
        return verb(**values, **{parameter: taken})

    parameters = []
    for name, each in inspect.signature(verb).parameters.items():
        if name == parameter:
            parameters += [_option(*option) for option in options.items()]
        else:
            parameters.append(each.replace(annotation=hints[name], kind=each.KEYWORD_ONLY))
    told.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    told.__annotations__ = {each.name: each.annotation for each in parameters}
    return told


def _option(name: str, option: tuple[Any, Any]) -> inspect.Parameter:
    annotation, default = option
    kind = inspect.Parameter.KEYWORD_ONLY
    return inspect.Parameter(name, kind, default=default, annotation=annotation)


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
