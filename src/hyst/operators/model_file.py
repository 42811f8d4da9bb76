"""Model files: versioned JSON that a person can read and that gives back every double exactly.

Nothing in a model file is executed or unpickled. An unknown version or entry is refused, because
guessing what a newer file means would move an actuator by the wrong amount.
"""

from __future__ import annotations

import json
import math
import os
import re
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any, NoReturn

from hyst.checks.numbers import as_number, as_sample_time, said, whole_number
from hyst.errors import InputError
from hyst.files import replacing

FORMAT = "hyst model"
VERSION = 1


@dataclass(frozen=True)
class ModelDescription:
    """What the numbers of a model mean; kept in the model file beside the model.

    Parameters
    ----------
    input_name, output_name
        Names of the signals.
    input_unit, output_unit
        Their units, as text.
    input_low, input_high, output_low, output_high
        Ranges of the record the model was identified from, if it was.
    dt
        Sample time of that record in seconds.
    delay
        Whole samples by which the measured output lagged the model's output in that record. The
        model itself has no delay, so that it has an exact inverse.
    family
        Family the model was identified in.

    Raises
    ------
    InputError
        If a name or unit is no text, a number is not finite or, for the delay, not whole, the delay
        is negative, dt is not positive, or a range is upside down.
    """

    input_name: str = "u"
    output_name: str = "y"
    input_unit: str = ""
    output_unit: str = ""
    input_low: float | None = None
    input_high: float | None = None
    output_low: float | None = None
    output_high: float | None = None
    dt: float | None = None
    delay: int = 0
    family: str = ""

    def __post_init__(self) -> None:
        for field in fields(self):
            value = _checked(field.name, getattr(self, field.name), str(field.type))
            object.__setattr__(self, field.name, value)
        if self.dt is not None:
            as_sample_time(self.dt)
        for signal in ("input", "output"):
            low, high = getattr(self, f"{signal}_low"), getattr(self, f"{signal}_high")
            if low is not None and high is not None and low > high:
                raise InputError(
                    f"{signal}_low is {low} and {signal}_high is {high}; give the lower end first"
                )


def write_model(
    path: str | os.PathLike[str], model: dict[str, Any], description: ModelDescription | None = None
) -> None:
    """Write a model file.

    Parameters
    ----------
    path
        File to create or replace, whole or not at all.
    model
        ``Operator.to_dict()``.
    description
        What the numbers mean.

    Raises
    ------
    InputError
        If the folder does not exist or the path is a folder.
    """
    about = {
        key: value
        for key, value in asdict(description or ModelDescription()).items()
        if value is not None
    }
    content = {"format": FORMAT, "version": VERSION, "description": about, "model": model}
    text = json.dumps(content, indent=2, allow_nan=False, ensure_ascii=False)
    with replacing(path) as temporary:
        temporary.write_text(_lists_on_one_line(text) + "\n", encoding="utf-8")


def read_model(path: str | os.PathLike[str]) -> tuple[dict[str, Any], ModelDescription]:
    """Read a model file as plain dictionaries; ``hyst.load`` gives the operator.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    model : dict
        For ``operator_from_dict``.
    description : ModelDescription

    Raises
    ------
    InputError
        If the file is not there, is not JSON, holds a number that is not finite, has another
        version, or a missing or unknown entry.
    """
    content = _parse(Path(path))
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise InputError(f"{path}: not a model file; its entry 'format' must be {FORMAT!r}")
    version = content.get("version")
    if type(version) is not int or version != VERSION:
        raise InputError(
            f"{path}: version {version!r} of the model file; this hyst reads version {VERSION}"
        )
    for key in ("description", "model"):
        if key not in content:
            raise InputError(f"{path}: the entry {key!r} is missing")
    unknown = sorted(set(content) - {"format", "version", "description", "model"})
    if unknown:
        raise InputError(f"{path}: unknown entry {unknown[0]!r}; remove it or update hyst")
    return content["model"], _description(path, content["description"])


def _parse(path: Path) -> Any:
    try:
        return json.loads(
            path.read_text(encoding="utf-8"),
            parse_constant=_refuse_number,
            parse_float=_finite,
            parse_int=_whole,
            object_pairs_hook=_distinct,
        )
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    except json.JSONDecodeError as error:
        where = f"line {error.lineno}, column {error.colno}"
        raise InputError(f"{path}: not JSON: {where}: {error.msg}") from None
    except RecursionError:
        raise InputError(f"{path}: lists or objects are nested too deeply") from None
    except ValueError as error:  # not UTF-8, or no path
        raise InputError(f"{str(path)!r} cannot be read: {error}") from None


def _refuse_number(text: str) -> NoReturn:
    raise InputError(f"the number {text[:24]} is not finite in double precision")


def _finite(text: str) -> float:
    number = float(text)
    if not math.isfinite(number):
        _refuse_number(text)
    return number


def _whole(text: str) -> int:
    _finite(text)  # a longer one could neither be used nor, beyond 4300 digits, be converted
    return int(text)


def _distinct(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key, value in pairs:
        if key in found:
            raise InputError(f"the entry {key!r} is there more than once")
        found[key] = value
    return found


def _description(path: str | os.PathLike[str], data: Any) -> ModelDescription:
    if not isinstance(data, dict):
        raise InputError(f"{path}: 'description' must be an object")
    known = {field.name for field in fields(ModelDescription)}
    for key, value in data.items():
        if key not in known:
            raise InputError(f"{path}: unknown entry {key!r} in 'description'")
        if value is None:
            raise InputError(f"{path}: {key!r} in 'description' is null; leave the entry out")
    try:
        return ModelDescription(**data)
    except InputError as error:
        raise InputError(f"{path}: in 'description', {error}") from None


def _checked(name: str, value: Any, wanted: str) -> Any:
    """Give a value of a description as the plain Python type that JSON knows."""
    if wanted == "str":
        # A lone surrogate cannot be written as UTF-8.
        if isinstance(value, str) and not re.search("[\ud800-\udfff]", value):
            return value
        raise InputError(f"{name} is {said(value)}; give text")
    if wanted == "int":
        # JSON has one kind of number: 2.0 counts as 2 does.
        is_whole = isinstance(value, float) and value.is_integer()
        return whole_number(int(value) if is_whole else value, name, 0)
    return None if value is None else as_number(value, name)


def _lists_on_one_line(text: str) -> str:
    """Put lists of numbers on one line each: a person reads p and r side by side."""
    # JSON writes a line feed inside a text as \n, so no text can look like a list over lines.
    number_list = re.compile(r"\[\n\s*(-?\d[^\[\]\"{}]*?)\n\s*\]")
    return number_list.sub(lambda found: "[" + re.sub(r"\s+", " ", found.group(1)) + "]", text)
