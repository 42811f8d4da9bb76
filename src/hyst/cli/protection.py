"""What a verb never does: write onto what it reads, or replace what is there unasked."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import hyst


def refuse_existing(parameters: Mapping[str, Any], target: Path | None, is_forced: bool) -> None:
    """Refuse a file that is there, and a folder that holds something.

    Parameters
    ----------
    parameters
        Of the verb, by name.
    target
        What it is to write, ``-o``; None for nothing.
    is_forced
        Whether that was asked for.

    Raises
    ------
    InputError
        If that would be replaced, or a file that is read.
    """
    if target is None:
        return
    if target.exists() and any(each.samefile(target) for each in files_among(parameters)):
        raise hyst.InputError(f"{target} is one of the files to read; write elsewhere")
    if is_forced:
        return
    if target.is_dir() and any(target.iterdir()):
        raise hyst.InputError(
            f"the folder {target} holds files already; name another with -o, or replace those "
            "of an earlier run with --force"
        )
    if target.is_file():
        raise hyst.InputError(f"{target} exists; name another with -o, or replace it: --force")


def files_among(parameters: Mapping[str, Any]) -> list[Path]:
    """Give the files among parameters that are not to be written: paths, and texts that are some.

    Parameters
    ----------
    parameters
        By name, without what the verb writes.
    """
    found = []
    for value in parameters.values():
        for each in value if isinstance(value, (list, tuple)) else [value]:
            if isinstance(each, (str, Path)) and each:
                with contextlib.suppress(OSError, ValueError):  # a text that is no path
                    found += [Path(each)] if Path(each).is_file() else []
    return found
