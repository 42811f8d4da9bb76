"""What a verb never does: write onto what it reads, or replace what is there unasked."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import hyst
from hyst._files import keeping

WRITTEN = ("folder", "out")
"""Names under which verbs take ``-o``."""


def refuse_existing(parameters: Mapping[str, Any], is_forced: bool) -> None:
    """Refuse a file that is there, and a folder that holds something.

    Parameters
    ----------
    parameters
        Of the verb, by name.
    is_forced
        Whether that was asked for.

    Raises
    ------
    InputError
        If that would be replaced, or a file that is read.
    """
    for target in _written(parameters):
        read = [each for each in _read(parameters) if _is_same(each, target)]
        if read:
            raise hyst.InputError(f"{target} is one of the files to read; write elsewhere")
        if is_forced:
            continue
        if target.is_dir() and any(target.iterdir()):
            raise hyst.InputError(
                f"the folder {target} holds files already; name another with -o, or replace those "
                "of an earlier run with --force"
            )
        if target.is_file():
            raise hyst.InputError(f"{target} exists; name another with -o, or replace it: --force")


@contextlib.contextmanager
def protected(parameters: Mapping[str, Any]) -> Iterator[None]:
    """Keep every file that a verb was given to read from being replaced, by any of its files."""
    with keeping(_read(parameters)):
        yield


def _written(parameters: Mapping[str, Any]) -> list[Path]:
    return [Path(parameters[name]) for name in WRITTEN if parameters.get(name) is not None]


def _read(parameters: Mapping[str, Any]) -> list[Path]:
    """Give the files among the parameters: paths, and texts that are some."""
    found = []
    for name, value in parameters.items():
        for each in value if isinstance(value, (list, tuple)) else [value]:
            if name not in WRITTEN and isinstance(each, (str, Path)) and each:
                with contextlib.suppress(OSError, ValueError):  # a text that is no path
                    found += [Path(each)] if Path(each).is_file() else []
    return found


def _is_same(one: Path, other: Path) -> bool:
    return other.exists() and one.samefile(other)
