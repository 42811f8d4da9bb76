"""The devices of a fleet, from names of files or from a table of them."""

from __future__ import annotations

import glob
import json
import math
import tomllib
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import hyst
from hyst._files import read_small
from hyst.checks.numbers import as_positive
from hyst.cli.fleet.file_source import FileSource

_FILE, _NAME = "file", "identifier"
_HOW = ("input", "output", "rate", "time", "time_unit")
_ENDS = {"min ": 0, "max ": 1}


def devices_of_files(patterns: Sequence[str], how: Mapping[str, Any]) -> list[FileSource]:
    """Give a device for each file, called as the file.

    Parameters
    ----------
    patterns
        Files, or patterns as ``RECORDS/*.csv``.
    how
        Arguments of ``hyst.read_record``.

    Raises
    ------
    InputError
        If a pattern meets no file, or no column is named.
    """
    files = list(dict.fromkeys(each for pattern in patterns for each in _met(pattern)))
    _require_columns(how, "--input and --output")
    stems = Counter(each.stem for each in files)
    return [
        FileSource(
            each.stem if stems[each.stem] == 1 else _longer_name(each),
            str(each.resolve()),
            how,
        )
        for each in files
    ]


def _met(pattern: str) -> list[Path]:
    if Path(pattern).is_file():
        return [Path(pattern)]
    found = sorted(Path(each) for each in glob.glob(pattern, recursive=True))
    files = [each for each in found if each.is_file()]
    if not files:
        if found:
            raise hyst.InputError(
                f"{pattern!r} is a folder; give the files in it, as '{pattern}/*.csv'"
            )
        raise hyst.InputError(
            f"{pattern!r} meets no file; give files, or a pattern as 'RECORDS/*.csv'"
        )
    return files


def _longer_name(file: Path) -> str:
    """Tell files of one name apart by folder and suffix."""
    return "/".join((*file.resolve().parent.parts[-1:], file.name))


def devices_of_table(path: Path, how: Mapping[str, Any]) -> list[FileSource]:
    """Give the devices of a table: ``file``, ``identifier``, columns and limits of each.

    Parameters
    ----------
    path
        CSV or Parquet; files in it are beside it, unless their paths are absolute.
    how
        Arguments of ``hyst.read_record``, where the table says nothing else.

    Raises
    ------
    InputError
        If a column is missing or not known, or a cell cannot be read.
    """
    rows = hyst.io.read_text_rows(path)
    names = tuple(rows[0])
    if _FILE not in names:
        raise hyst.InputError(f"{path} has no column 'file'; it has {', '.join(names)}")
    for name in names:
        if name not in (_FILE, _NAME, *_HOW) and not name.startswith(tuple(_ENDS)):
            raise hyst.InputError(
                f"{path} has the column {name!r}; it may have {_FILE}, {_NAME}, {', '.join(_HOW)}, "
                "and limits as 'min gain' or 'max rms_percent'"
            )
    return [_device(path, number, row, how) for number, row in enumerate(rows, 2)]


def _device(path: Path, number: int, row: Mapping[str, str], how: Mapping[str, Any]) -> FileSource:
    where = f"{path}, row {number}"
    if not row[_FILE]:
        raise hyst.InputError(f"{where} names no file; name one in the column 'file'")
    own = {name: row[name] for name in _HOW if row.get(name)}
    read = {**how, **own}
    if "rate" in own:
        read["rate"] = as_positive(_number(own["rate"], f"{where}, rate"), "rate", "Hz")
        read["time"] = None
    elif "time" in own:
        read["rate"] = None
    _require_columns(read, f"{where}: columns 'input' and 'output'")
    file = path.parent / row[_FILE]
    limits = _limits(row, where)
    return FileSource(row.get(_NAME) or Path(row[_FILE]).stem, str(file.resolve()), read, limits)


def _limits(row: Mapping[str, str], where: str) -> dict[str, tuple[float | None, float | None]]:
    pairs: dict[str, list[float | None]] = {}
    for name, text in row.items():
        for start, place in _ENDS.items():
            if name.startswith(start) and text:
                pair = pairs.setdefault(name.removeprefix(start), [None, None])
                pair[place] = _number(text, f"{where}, {name}")
    return hyst.fleet.as_limits({name: tuple(pair) for name, pair in pairs.items()}, where)


def _number(text: str, where: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise hyst.InputError(f"{where}: {text!r} is no number; give one")
    return value


def _require_columns(how: Mapping[str, Any], where: str) -> None:
    for name in ("input", "output"):
        if how.get(name) is None:
            raise hyst.InputError(f"no {name} column is named; name both by {where}")


def limits_typed(
    texts: Sequence[str] | None, file: Path | None
) -> dict[str, tuple[float | None, float | None]]:
    """Give the limits of all devices: those of a file, and those typed over them.

    Parameters
    ----------
    texts
        As ``rms_percent<0.5``.
    file
        TOML or JSON: a table for each quantity, with min, max or both.

    Raises
    ------
    InputError
        If one cannot be read, or a quantity is not known.
    """
    found: dict[str, tuple[float | None, float | None]] = {}
    if file is not None:
        try:
            content = read_small(file).decode("utf-8")
            data = json.loads(content) if file.suffix == ".json" else tomllib.loads(content)
        except (OSError, ValueError) as error:
            raise hyst.InputError(f"{file} cannot be read as limits: {error}") from None
        found = hyst.fleet.as_limits(data, f"limits of {file}")
    for text in texts or ():
        for name, (low, high) in hyst.fleet.parse_limit(text).items():
            before = found.get(name, (None, None))
            found[name] = (before[0] if low is None else low, before[1] if high is None else high)
    return hyst.fleet.as_limits(found)
