"""What is asked of a target, and what it answers."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from hyst.export.c.block import Model
    from hyst.export.c.drive_range import DriveRange
    from hyst.operators import Driver

_SHOWN = 6  # drives of a history


@dataclass(frozen=True)
class Order:
    """What is asked for: which model, where to, and how.

    Parameters
    ----------
    model, out
        What is exported, and where to.
    precision, name, force, fmi, binary, despite_verdict, layout, shared_core
        As the verb is given them.
    limits, rate_limit, history, driver, history_at
        Of the drive.
    """

    model: Model
    out: Path
    precision: str
    name: str
    force: bool
    fmi: str
    binary: bool
    despite_verdict: bool
    layout: str
    shared_core: bool
    limits: tuple[float, float] | str
    rate_limit: float | None
    history: list[float] | None
    driver: Driver | str = "auto"
    history_at: float | None = None

    @property
    def drive(self) -> dict[str, Any]:
        """What it is told of the drive, by the names in Python."""
        at = {} if self.history_at is None else {"history_at": self.history_at}
        told = {"limits": self.limits, "rate_limit": self.rate_limit, "history": self.history}
        return told | at


@dataclass(frozen=True)
class Done:
    """What has been written.

    Parameters
    ----------
    rows
        Of the table.
    next_step
        What to do next.
    """

    rows: tuple[tuple[str, str], ...]
    next_step: str


def drive_rows(
    drive: DriveRange, history: tuple[float, ...], start: str = ""
) -> tuple[tuple[str, str], ...]:
    """Give the rows that tell limits and start.

    Parameters
    ----------
    drive, history
        As they have been written.
    start
        What starts it after another history; "" for nothing.
    """
    said = "as nothing had ever driven it"
    if history:
        more = f" ... ({len(history)} drives)" if len(history) > _SHOWN else ""
        said = "after " + ", ".join(f"{each:.6g}" for each in history[:_SHOWN]) + more
    return ("limits", drive.said()), ("start", said + (f"; or {start}" if start else ""))


def quoted(path: str | Path) -> str:
    """Give a path as a shell takes it."""
    return shlex.quote(str(path))


def into_folder(order: Order) -> tuple[str, str]:
    """Give the folder the files are in, and the shell's command that goes there."""
    zipped = order.out.suffix.lower() == ".zip"
    folder = order.name if zipped else str(order.out)
    unpack = f"unzip {quoted(order.out)} && " if zipped else ""
    return folder, f"{unpack}cd {quoted(folder)}"
