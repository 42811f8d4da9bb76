"""What is asked of a target, and what it answers."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from hyst.export.c.block import Model


@dataclass(frozen=True)
class Order:
    """What is asked for: which model, where to, and how."""

    model: Model
    out: Path
    precision: str
    name: str
    force: bool
    fmi: str
    binary: bool
    despite_verdict: bool
    flat: bool


@dataclass(frozen=True)
class Done:
    """What has been written: rows for the table, and what to do next."""

    rows: tuple[tuple[str, str], ...]
    next_step: str


def quoted(path: str | Path) -> str:
    """Give a path as a shell takes it."""
    return shlex.quote(str(path))


def into_folder(order: Order) -> tuple[str, str]:
    """Give the folder the files are in, and the shell's command that goes there."""
    zipped = order.out.suffix.lower() == ".zip"
    folder = order.name if zipped else str(order.out)
    unpack = f"unzip {quoted(order.out)} && " if zipped else ""
    return folder, f"{unpack}cd {quoted(folder)}"
