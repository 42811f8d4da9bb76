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
        Ranges of the record the model was identified from, if it was; NaN is not allowed.
    dt
        Sample time of that record in seconds.
    delay
        Whole samples by which the measured output lagged the model's output in that record. The
        model itself has no delay, so that it has an exact inverse.
    family
        Family the model was identified in.
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
    if content.get("version") != VERSION:
        raise InputError(
            f"{path}: version {content.get('version')!r} of the model file; "
            f"this hyst reads version {VERSION}"
        )
    for key in ("description", "model"):
        if key not in content:
            raise InputError(f"{path}: the entry {key!r} is missing")
    unknown = sorted(set(content) - {"format", "version", "description", "model"})
    if unknown:
        raise InputError(f"{path}: unknown entry {unknown[0]!r}; remove it or update hyst")
    return content["model"], _description(path, content["description"])


def _parse(path: Path) -> Any:
    def refuse(text: str) -> NoReturn:
        raise InputError(f"{path}: the number {text} is not finite")

    def finite(text: str) -> float:
        number = float(text)
        if not math.isfinite(number):
            refuse(text)
        return number

    def distinct(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        keys = [key for key, _ in pairs]
        for key in keys:
            if keys.count(key) > 1:
                raise InputError(f"{path}: the entry {key!r} is there more than once")
        return dict(pairs)

    try:
        text = path.read_text(encoding="utf-8")
        return json.loads(
            text, parse_constant=refuse, parse_float=finite, object_pairs_hook=distinct
        )
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    except (UnicodeDecodeError, json.JSONDecodeError, RecursionError) as error:
        raise InputError(f"{path}: not JSON: {error}") from None


def _description(path: str | os.PathLike[str], data: Any) -> ModelDescription:
    if not isinstance(data, dict):
        raise InputError(f"{path}: 'description' must be an object")
    known = {field.name: field for field in fields(ModelDescription)}
    for key, value in data.items():
        if key not in known:
            raise InputError(f"{path}: unknown entry {key!r} in 'description'")
        if not _fits(value, str(known[key].type)):
            raise InputError(
                f"{path}: 'description' has {key} = {value!r}; {known[key].type} wanted"
            )
    return ModelDescription(**data)


def _fits(value: Any, wanted: str) -> bool:
    if wanted == "str":
        return isinstance(value, str)
    if wanted == "int":
        return isinstance(value, int) and not isinstance(value, bool)
    return isinstance(value, int | float) and not isinstance(value, bool)


def _lists_on_one_line(text: str) -> str:
    """Put lists of numbers on one line each: a person reads p and r side by side."""
    number_list = re.compile(r"\[\s+(-?\d[^\[\]\"{}]*?)\s+\]")
    return number_list.sub(lambda found: "[" + re.sub(r"\s+", " ", found.group(1)) + "]", text)
