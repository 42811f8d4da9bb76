"""hyst diagnose: what records can tell, and what they cannot, before any model."""

from __future__ import annotations

import json
import textwrap
from pathlib import Path
from typing import Annotated

import typer

import hyst
from hyst._files import replacing
from hyst.cli.arguments import InputColumn, OutputColumn, Rate, Repair, TimeColumn, TimeUnit
from hyst.cli.console import at_work, show_files
from hyst.cli.excite import write_drive
from hyst.cli.fitted import Data, HowToRead, InputLabel, OutputLabel

Out = Annotated[
    Path | None,
    typer.Option(
        "-o", "--out", metavar="FILE", show_default=False, help="Write the findings as JSON, too."
    ),
]
Next = Annotated[
    Path | None,
    typer.Option(
        "--next",
        metavar="FILE",
        show_default=False,
        help="Write the drive that would add most: CSV and figure, as hyst excite.",
    ),
]

_WIDTH = 96


def diagnose(
    data: Data,
    input_column: InputColumn,
    output_column: OutputColumn,
    rate: Rate = None,
    time: TimeColumn = None,
    time_unit: TimeUnit = None,
    repair: Repair = False,
    input_label: InputLabel = None,
    output_label: OutputLabel = None,
    out: Out = None,
    next_file: Next = None,
) -> None:
    """Say what records show before any model, the worst first, and what to record next."""
    columns = {"input": input_column, "output": output_column, "time": time, "rate": rate}
    columns |= {"time_unit": time_unit, "repair": repair}
    files = HowToRead(columns, {}, (input_label, output_label))
    with at_work("diagnosing"):
        found = hyst.diagnose(files.records(data))
    _tell(found, data)
    if out is not None:
        with replacing(out) as temporary:
            temporary.write_text(json.dumps(found.to_dict(), indent=1) + "\n", encoding="utf-8")
        show_files([out])
    if next_file is not None:
        if found.next_drive is None:
            raise hyst.InputError(
                "nothing moves in these records, so no drive can be derived from them; design one "
                "with hyst excite"
            )
        show_files(write_drive(found.next_drive.drive, next_file, found.next_drive.label))


def _tell(found: hyst.Diagnosis, data: list[Path]) -> None:
    """Print the findings; records are numbered as their files were given."""
    if len(data) > 1:
        for number, path in enumerate(data, 1):
            print(f"record {number}: {path}")
    for each in found.findings:
        print()
        _print(f"{each.severity}: {each.name}: {each.sentence}", "")
        if each.advice:
            # Commands stay in one line, to be copied.
            print(f"  {each.advice}") if "hyst excite" in each.advice else _print(each.advice, "  ")


def _print(text: str, indent: str) -> None:
    for line in textwrap.wrap(
        text, _WIDTH, initial_indent=indent, subsequent_indent=indent or "  ",
        break_long_words=False, break_on_hyphens=False,
    ):  # fmt: skip
        print(line)
