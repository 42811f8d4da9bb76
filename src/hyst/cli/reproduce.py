"""hyst reproduce: the papers' numbers beside ours."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from hyst._files import replacing_files, require_folder
from hyst.cli.console import at_work, show_files, show_table
from hyst.studies import keys, study

Which = Annotated[str, typer.Argument(metavar="[s0|..|all]", help="Which study.")]
Folder = Annotated[
    Path | None,
    typer.Option("-o", "--out", metavar="DIR", show_default=False, help="Write figures there."),
]


def reproduce(which: Which = "all", folder: Folder = None) -> None:
    """Compute the papers' tables again, and print them beside the papers' numbers."""
    drawn: dict[str, bytes] = {}
    if folder is not None:
        require_folder(folder)
    for key in keys() if which == "all" else (which,):
        each = study(key)
        with at_work(f"reproducing {key}"):
            tables = each.tables()
            drawn |= each.figures() if folder is not None else {}
        print(f"{key}: {each.title}")
        for table in tables:
            show_table(table)
    if folder is not None:
        with replacing_files(folder) as temporary:
            for name, content in drawn.items():
                (temporary / name).write_bytes(content)
        show_files([folder / name for name in drawn])
