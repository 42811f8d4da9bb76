"""hyst fit: the constants of any model file, fitted to records from their own values."""

from __future__ import annotations

import math
from typing import Annotated, Any

import typer

import hyst
from hyst._files import require_folder
from hyst.cli.arguments import (
    ModelFile,
    load_operator,
    numbers,
    require_same_unit,
    whole_or_auto,
)
from hyst.cli.console import at_work, show_files
from hyst.cli.driver_option import DriverOfInput, driver_of
from hyst.cli.fitted import (
    AllowUnconverged,
    Data,
    Folder,
    HowToRead,
    InputLabel,
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
from hyst.cli.reading_options import reads_records

Free = Annotated[
    str | None,
    typer.Option(
        metavar="A,B,..",
        show_default=False,
        help="Constants that may move, as hyst info names them; a name without its index, or of a "
        "stage, stands for all in it. All if left out.",
    ),
]
Bound = Annotated[
    list[str] | None,
    typer.Option(
        "--bound",
        metavar="NAME=LOW,HIGH",
        show_default=False,
        help="Keep a constant between two values; repeatable.",
    ),
]
Delay = Annotated[
    float | None,
    typer.Option(
        metavar="N", show_default=False, help="Samples by which the output lags; the model's own."
    ),
]
Start = Annotated[str, typer.Option(metavar="N|auto", help="First sample to use.")]


@reads_records
def fit(
    model: ModelFile,
    data: Data,
    folder: Folder,
    how: dict[str, Any],
    free: Free = None,
    bound: Bound = None,
    delay: Delay = None,
    start: Start = "auto",
    validate: Validate = None,
    validate_input: ValidateInput = None,
    validate_output: ValidateOutput = None,
    validate_time: ValidateTime = None,
    input_label: InputLabel = None,
    output_label: OutputLabel = None,
    driver: DriverOfInput = None,
    allow_unconverged: AllowUnconverged = False,
) -> int:
    """Fit the constants of a model to records, from its own values, and report as identify does."""
    require_folder(folder)
    guess = load_operator(model)
    bounds = dict(_as_bound(each) for each in bound or [])
    others = {"input": validate_input, "output": validate_output, "time": validate_time}
    files = HowToRead(how, others, (input_label, output_label), driver_of(driver))
    with at_work("fitting") as say:
        say("reading")
        records = files.records(data)
        validation = files.validation(validate)
        for record in (*records, *validation):
            require_same_unit(record.input_unit, guess.description.input_unit, "the input")
            require_same_unit(record.output_unit, guess.description.output_unit, "the output")
        found = hyst.fit(
            guess,
            records,
            free=None if free is None else [each.strip() for each in free.split(",")],
            bounds=bounds or None,
            delay=_own_delay(guess, records[0]) if delay is None else delay,
            start=whole_or_auto(start, "start"),
            validation=validation,
            allow_unconverged=allow_unconverged,
            progress=say,
        )
        say("report")
        found = hyst.identification.with_driver(named_by_files(found, files.sources), files.driver)
        written = write_fitted(found, records, validation, folder, files.sources)
    tell_fitted(found, records)
    show_files(written)
    return ended(found)


def _own_delay(guess: hyst.Operator, record: hyst.Record) -> Any:
    """Give the delay of the model file, whose samples are those of the record it was made from."""
    about = guess.description
    if about.delay and about.dt is not None and not math.isclose(about.dt, record.dt, rel_tol=1e-6):
        raise hyst.InputError(
            f"the model's delay is {about.delay} samples of {about.dt:.6g} s, the record's are of "
            f"{record.dt:.6g} s; give --delay in samples of the record"
        )
    return about.delay  # hyst.fit says which delays it can take


def _as_bound(text: str) -> tuple[str, tuple[float, float]]:
    """Read NAME=LOW,HIGH."""
    name, _, values = text.partition("=")
    low_high = numbers(values, "bound") if values else []
    if not name or len(low_high) != 2:
        raise hyst.InputError(
            f"--bound is {text!r}; give a name and two numbers, as prandtl_ishlinskii.p0=0.5,2"
        )
    return name.strip(), (low_high[0], low_high[1])
