"""Arguments that several verbs take, and how their text is read."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import typer

import hyst
from hyst.checks.numbers import as_positive

ModelFile = Annotated[
    Path,
    typer.Argument(metavar="MODEL", show_default=False, help="Model file, as identify writes."),
]
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


def load_operator(path: Path) -> hyst.operators.Operator:
    """Read a model file that holds an operator, and nothing else."""
    found = hyst.load(path)
    if not isinstance(found, hyst.operators.Operator):
        raise hyst.InputError(
            f"{path} holds a {type(found).__name__}, not one input's model; give a model file, as "
            "hyst identify writes"
        )
    return found


def whole_auto_or_none(text: str, name: str) -> int | Literal["auto"] | None:
    """Read a whole number, or the word auto or none."""
    if text in ("auto", "none"):
        return None if text == "none" else "auto"
    try:
        return int(text)
    except ValueError:
        raise hyst.InputError(f"--{name} is {text!r}; give a whole number, auto or none") from None


def whole_or_auto(text: str, name: str) -> int | Literal["auto"]:
    """Read a whole number or the word auto."""
    if text == "auto":
        return "auto"
    try:
        return int(text)
    except ValueError:
        raise hyst.InputError(f"--{name} is {text!r}; give a whole number or auto") from None


def number_or_auto(text: str, name: str, more: str = "") -> float | Literal["auto"]:
    """Read a number, a whole one as such, or the word auto; the message says what more may be."""
    if text == "auto":
        return "auto"
    try:
        value = float(text)
    except ValueError:
        raise hyst.InputError(f"--{name} is {text!r}; give a number or auto{more}") from None
    return int(value) if value.is_integer() else value


def numbers(text: str, name: str) -> list[float]:
    """Read numbers with commas between them."""
    try:
        return [float(each) for each in text.split(",")]
    except ValueError:
        raise hyst.InputError(
            f"--{name} is {text!r}; give numbers with commas between them, as 0,3.6"
        ) from None


def history_of(text: str) -> list[float]:
    """Read the drive before the first sample: turns with commas between them, or FILE:COLUMN.

    Parameters
    ----------
    text
        As it was typed.

    Raises
    ------
    InputError
        If it is neither.
    """
    file, colon, column = text.rpartition(":")
    if not (colon and Path(file).exists()):
        return numbers(text, "history")
    values: list[float] = hyst.io.read_column(file, column)[0].tolist()
    return values


def sample_time_known(
    model: hyst.operators.Operator, file: Path, rate: float | None, what: str, **how: Any
) -> bool:
    """Refuse a file of another sample time than the model's; say if the file or --rate tells."""
    if rate is not None:
        model.require_sample_time(1.0 / as_positive(rate, "--rate", "samples per second"), what)
        return True
    if model.dt is None:
        return True
    found = hyst.io.read_time_step(file, **how)
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


def refuse_inputs_as_outputs(outputs: Sequence[Path], inputs: Sequence[Path]) -> None:
    """Refuse to write onto a file that is read."""
    read = {each.resolve() for each in inputs}
    for each in outputs:
        if each.resolve() in read:
            raise hyst.InputError(f"{each} is one of the files to read; write elsewhere")
