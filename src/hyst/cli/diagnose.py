"""hyst diagnose: what records can tell, and what they cannot, before any model."""

from __future__ import annotations

import json
import textwrap
from pathlib import Path
from typing import Annotated, Any

import typer

import hyst
from hyst._files import replacing
from hyst.cli.console import at_work, show_files
from hyst.cli.driver_option import DriverOfInput, driver_of
from hyst.cli.excite import write_drive
from hyst.cli.fitted import Data, HowToRead, InputLabel, OutputLabel
from hyst.cli.reading_options import reads_records

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


@reads_records
def diagnose(
    data: Data,
    how: dict[str, Any],
    input_label: InputLabel = None,
    output_label: OutputLabel = None,
    out: Out = None,
    next_file: Next = None,
    driver: DriverOfInput = None,
) -> None:
    """Say what records show before any model, the worst first, and what to record next."""
    files = HowToRead(how, {}, (input_label, output_label), driver_of(driver))
    with at_work("diagnosing"):
        found = hyst.diagnose(files.records(data))
    _tell(found, files.sources)
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


def _tell(found: hyst.Diagnosis, sources: list[str]) -> None:
    """Print the findings; records are numbered as their files were given."""
    if len(sources) > 1:
        for number, source in enumerate(sources, 1):
            print(f"record {number}: {source}")
    for each in found.findings:
        print()
        _print(f"{each.severity}: {each.name}: {each.sentence}", "")
        if "hyst excite" in each.advice:
            # Commands stay in one line, to be copied.
            print(f"  {each.advice}")
        elif each.advice:
            _print(each.advice, "  ")


def _print(text: str, indent: str) -> None:
    for line in textwrap.wrap(
        text, _WIDTH, initial_indent=indent, subsequent_indent=indent or "  ",
        break_long_words=False, break_on_hyphens=False,
    ):  # fmt: skip
        print(line)
