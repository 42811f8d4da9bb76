"""What the verbs say: tables, notes, and that they are still at work.

rich, which draws on terminals, is loaded where there is one.
"""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.table import Table as RichTable

    from hyst.report.table import Table

WIDEST_NUMBER = 40
"""Characters: columns with longer cells hold sentences, which start at the left."""


def show_table(table: Table) -> None:
    """Print a table: ruled on a terminal, aligned plain text elsewhere."""
    if sys.stdout.isatty():
        from rich.console import Console

        Console().print(_ruled(table))
    else:
        print(f"\n{table.title}")
        print("\n".join(_aligned(table)))


def show_files(files: Sequence[Path]) -> None:
    """Print which files were written; all lie in one folder."""
    print(f"\nwrote {', '.join(each.name for each in files)} in {files[0].parent}")


def note(text: str) -> None:
    """Say on stderr what the user should know but did not ask for."""
    print(f"note: {text}", file=sys.stderr)


@contextlib.contextmanager
def at_work(what: str) -> Iterator[Callable[[str], None]]:
    """Show on a terminal that something is going on, and give a way to say what."""
    if not sys.stderr.isatty():
        yield _say_nothing
        return
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task(what, total=None)
        yield lambda text: progress.update(task, description=f"{what}: {text}")


@contextlib.contextmanager
def progress_bar(what: str) -> Iterator[Callable[[float], None]]:
    """Show on a terminal how much of something long is done, and give a way to say it."""
    if not sys.stderr.isatty():
        yield _say_nothing
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task(what, total=1.0)
        yield lambda share: progress.update(task, completed=share)


def _say_nothing(_: object) -> None:
    """Tell nobody."""


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
