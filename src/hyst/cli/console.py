"""What the verbs say: tables, notes, and that they are still at work.

rich, which draws on terminals, is loaded where there is one.
"""

from __future__ import annotations

import contextlib
import json
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextvars import ContextVar
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.table import Table as RichTable

    from hyst.report.table import Table

WIDEST_NUMBER = 40
"""Characters: columns with longer cells hold sentences, which start at the left."""


@dataclass
class Told:
    """What was told, kept to be printed as JSON.

    Parameters
    ----------
    tables
        With title, header and rows.
    files
        That were written.
    notes
        Of ``note``.
    """

    tables: list[dict[str, Any]] = field(default_factory=list)
    files: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def collected(self, said: str) -> dict[str, Any]:
        """Give all of it, with lines that were printed, and the numbers if they are in a file."""
        lines = [line.strip() for line in said.splitlines() if line.strip()]
        numbers = [Path(each) for each in self.files if Path(each).name == "metrics.json"]
        kept: dict[str, Any] = {
            "said": lines,
            "tables": self.tables,
            "files": self.files,
            "notes": self.notes,
        }
        for each in numbers:
            kept["metrics"] = json.loads(each.read_text(encoding="utf-8"))
        return kept


@dataclass(frozen=True)
class _Manner:
    is_quiet: bool = False
    is_verbose: bool = False
    told: Told | None = None


_PLAIN = _Manner()
_MANNER: ContextVar[_Manner] = ContextVar("how much is said", default=_PLAIN)


@contextlib.contextmanager
def speaking(
    *, is_quiet: bool = False, is_verbose: bool = False, told: Told | None = None
) -> Iterator[None]:
    """Say nothing, or also steps, or keep what is told, while something is carried out."""
    token = _MANNER.set(_Manner(is_quiet, is_verbose, told))
    try:
        yield
    finally:
        _MANNER.reset(token)


def show_table(table: Table) -> None:
    """Print a table: ruled on a terminal, aligned plain text elsewhere."""
    told = _MANNER.get().told
    if told is not None:
        rows = [list(each) for each in table.rows]
        told.tables.append({"title": table.title, "header": list(table.header), "rows": rows})
    elif sys.stdout.isatty():
        from rich.console import Console

        Console().print(_ruled(table))
    else:
        print(f"\n{table.title}")
        print("\n".join(_aligned(table)))


def show_files(files: Sequence[Path]) -> None:
    """Print which files were written; all lie in one folder."""
    told = _MANNER.get().told
    if told is not None:
        told.files.extend(str(each) for each in files)
        return
    print(f"\nwrote {', '.join(each.name for each in files)} in {files[0].parent}")


def note(text: str) -> None:
    """Say on stderr what the user should know but did not ask for."""
    manner = _MANNER.get()
    if manner.told is not None:
        manner.told.notes.append(text)
    elif not manner.is_quiet:
        print(f"note: {text}", file=sys.stderr)


@contextlib.contextmanager
def at_work(what: str) -> Iterator[Callable[[str], None]]:
    """Show on a terminal that something is going on, and give a way to say what.

    Words that know their share of the way, as those of an identification, are drawn as a bar.
    """
    if _MANNER.get().is_verbose:
        begun = time.monotonic()
        yield lambda text: _print_step(what, text, time.monotonic() - begun)
        return
    with _drawn(what, None) as update:
        yield lambda text: update(
            description=f"{what}: {text}", completed=getattr(text, "share", None)
        )


@contextlib.contextmanager
def progress_bar(what: str) -> Iterator[Callable[[float], None]]:
    """Show on a terminal how much of something long is done, and give a way to say it."""
    with _drawn(what, 1.0) as update:
        yield lambda share: update(completed=share)


def _print_step(what: str, text: str, seconds: float) -> None:
    print(f"{seconds:8.2f} s  {what}: {text}", file=sys.stderr)


@contextlib.contextmanager
def _drawn(what: str, total: float | None) -> Iterator[Callable[..., None]]:
    """Draw a bar, or only a sign of life where no share is known, and give a way to move it."""
    manner = _MANNER.get()
    if manner.is_quiet or not sys.stderr.isatty():
        yield lambda **_: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task(what, total=total)

        def update(**of_bar: Any) -> None:
            if of_bar.get("completed") is not None:
                of_bar["total"] = 1.0
            progress.update(task, **of_bar)

        yield update


def _ruled(table: Table) -> RichTable:
    from rich.table import Table as RichTable
    from rich.text import Text

    # Text instead of markup: names from the user's file may hold brackets.
    ruled = RichTable(title=Text(table.title), title_justify="left", title_style="bold")
    for index, heading in enumerate(table.header):
        width = max(len(row[index]) for row in (table.header, *table.rows))
        is_text = index == 0 or width > WIDEST_NUMBER
        ruled.add_column(Text(heading), justify="left" if is_text else "right")
    for index, row in enumerate(table.rows):
        style = "bold" if index == table.marked else None
        ruled.add_row(*(Text(cell) for cell in row), style=style)
    return ruled


def _aligned(table: Table) -> Iterator[str]:
    rows = [table.header, *table.rows]
    widths = [max(len(row[column]) for row in rows) for column in range(len(table.header))]
    for row in rows:
        cells = [
            cell.ljust(width) if column == 0 or width > WIDEST_NUMBER else cell.rjust(width)
            for column, (cell, width) in enumerate(zip(row, widths, strict=True))
        ]
        yield "  " + "  ".join(cells).rstrip()
