"""Files of models and estimators: versioned JSON that a person can read, every double exact.

Nothing in a model file is executed or unpickled. An unknown version or entry is refused, because
guessing what a newer file means would move an actuator by the wrong amount.
"""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn, final

from hyst._files import read_small, replacing
from hyst.errors import InputError
from hyst.operators.description import ModelDescription, as_description


@final
@dataclass(frozen=True)
class Format:
    """A kind of file.

    Parameters
    ----------
    name
        Its entry ``format``.
    holds
        What messages call it.
    versions
        Those that can be read, by the version their descriptions have; the first one that has all
        that is to be told is written, so that what has nothing new is read by older ones, too.
    entries
        What it must have beside format, version and description.
    """

    name: str
    holds: str
    versions: Mapping[int, int]
    entries: tuple[str, ...]


# Version 2 of a description: errors and provenance; version 3: a verdict, and a delay that may be a
# fraction or negative with its interval; version 4: errors of dynamics; version 5: a driver, and
# whether it is an inverse. A model file must have one, an estimator's file of version 2 may;
# version 1 of those knew no search beside the estimate and is not read.
MODEL = Format("hyst model", "model", {1: 1, 2: 2, 3: 3, 4: 4, 5: 5}, ("model",))
ESTIMATOR = Format(
    "hyst estimator", "estimator", {2: 1, 3: 2, 4: 3, 5: 4, 6: 5}, ("kind", "settings", "state")
)
LEARNING = Format("hyst learning", "learning", {1: 1, 2: 2, 3: 3, 4: 4, 5: 5}, ("learning",))
SHARED_SHAPE = Format("hyst shared shape", "shared shape", {3: 3, 4: 4, 5: 5}, ("shared_shape",))
LOADED = (MODEL, ESTIMATOR, LEARNING)
"""What ``hyst.load`` reads; a shared shape is read where it is defined."""


@final
@dataclass(frozen=True)
class SavedFile:
    """What was read from a file.

    Parameters
    ----------
    format
        Which kind of file it is.
    content
        Its entries, those of ``format.entries``.
    description
        What the numbers mean.
    """

    format: Format
    content: dict[str, Any]
    description: ModelDescription


def write_file(
    path: str | os.PathLike[str],
    form: Format,
    content: dict[str, Any],
    description: ModelDescription,
) -> None:
    """Write a file that ``hyst.load`` reads.

    Parameters
    ----------
    path
        File to create or replace, whole or not at all.
    form
        The kind of file.
    content
        The entries of the format.
    description
        What the numbers mean.

    Raises
    ------
    InputError
        If the folder does not exist or the path is a folder, or the description is none.
    """
    about = as_description(description)
    version = min(each for each, own in form.versions.items() if own >= about.version)
    told = {"version": version, "description": about.to_dict()}
    whole = {"format": form.name, **told, **content}
    text = json.dumps(whole, indent=2, allow_nan=False, ensure_ascii=False)
    with replacing(path) as temporary:
        temporary.write_text(_lists_on_one_line(text) + "\n", encoding="utf-8")


def read_file(path: str | os.PathLike[str], formats: tuple[Format, ...] = LOADED) -> SavedFile:
    """Read a file as plain dictionaries; ``hyst.load`` gives what it holds.

    Parameters
    ----------
    path
        The file.
    formats
        The kinds of file that are wanted.

    Returns
    -------
    SavedFile

    Raises
    ------
    InputError
        If the file is not there, is not JSON, holds a number that is not finite, has another
        format or version, or a missing or unknown entry.
    """
    content = _parse(Path(path))
    by_name = {each.name: each for each in formats}
    form = by_name.get(str(content.get("format"))) if isinstance(content, dict) else None
    if form is None:
        known = " or ".join(repr(name) for name in by_name)
        what = "model" if MODEL in formats else formats[0].holds
        raise InputError(f"{path}: not a {what} file; its entry 'format' must be {known}")
    version = content.get("version")
    if type(version) is not int or version not in form.versions:
        *others, last = (str(each) for each in form.versions)
        known = f"{', '.join(others)} and {last}"
        raise InputError(
            f"{path}: version {version!r} of the {form.holds} file; this hyst reads versions "
            f"{known}; use the hyst that wrote it"
        )
    is_optional = form is ESTIMATOR and version == 2
    required = form.entries if is_optional else ("description", *form.entries)
    for key in required:
        if key not in content:
            raise InputError(f"{path}: the entry {key!r} is missing")
    unknown = sorted(set(content) - {"format", "version", "description", *form.entries})
    if unknown:
        raise InputError(f"{path}: unknown entry {unknown[0]!r}; remove it or update hyst")
    about = content.get("description", {})
    if is_optional and isinstance(about, dict):  # they wrote null for what is not known
        about = {key: value for key, value in about.items() if value is not None}
    try:
        description = ModelDescription.from_dict(about, form.versions[version])
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    except RecursionError:
        raise InputError(f"{path}: lists or objects are nested too deeply") from None
    return SavedFile(form, {key: content[key] for key in form.entries}, description)


def _parse(path: Path) -> Any:
    try:
        content = read_small(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    except ValueError as error:  # no path
        if isinstance(error, InputError):
            raise
        raise InputError(f"{str(path)!r} cannot be read: {error}") from None
    try:
        return json.loads(
            content.decode("utf-8"),
            parse_constant=_refuse_number,
            parse_float=_finite,
            parse_int=_whole,
            object_pairs_hook=_distinct,
        )
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    except json.JSONDecodeError as error:
        where = f"line {error.lineno}, column {error.colno}"
        raise InputError(f"{path}: not JSON: {where}: {error.msg}") from None
    except RecursionError:
        raise InputError(f"{path}: lists or objects are nested too deeply") from None
    except ValueError as error:  # not UTF-8
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


def _lists_on_one_line(text: str) -> str:
    """Put lists of numbers on one line each: a person reads p and r side by side."""
    # JSON writes a line feed inside a text as \n, so no text can look like a list over lines.
    number_list = re.compile(r"\[\n\s*(-?\d[^\[\]\"{}]*?)\n\s*\]")
    return number_list.sub(lambda found: "[" + re.sub(r"\s+", " ", found.group(1)) + "]", text)
