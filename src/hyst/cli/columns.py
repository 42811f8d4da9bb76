"""hyst columns: what a data file holds, before anything is made of it."""

from __future__ import annotations

import math
import shlex
from pathlib import Path
from typing import Annotated, Any

import typer

import hyst
from hyst.cli.console import note, show_table
from hyst.cli.reading_options import reads_columns

_LISTED = 12


@reads_columns
def columns(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", show_default=False, help="A file of measured signals.")
    ],
    how: dict[str, Any],
) -> None:
    """List the columns of a data file, and guess which are input, output and time."""
    found = hyst.io.summarize_file(file, **how)
    number = hyst.report.number
    rows = tuple(
        (
            f"{each.index}: {each.header}",
            each.name if each.name != each.header else "",
            each.unit,
            str(each.size),
            "-" if math.isnan(each.low) else number(each.low, 6),
            "-" if math.isnan(each.high) else number(each.high, 6),
            each.guess,
        )
        for each in found.columns
    )
    header = ("column", "name", "unit", "values", "from", "to", "guess")
    show_table(hyst.report.Table(f"Columns of {file.name}", header, rows))
    for each in found.columns:
        if each.flaw:
            note(f"{each.header!r}: {each.flaw}")
    _tell_left_out(found.left_out)
    _suggest(file, found, how)


def _tell_left_out(left_out: tuple[tuple[str, str], ...]) -> None:
    told = [(name, reason) for name, reason in left_out if reason != "is a single number"]
    for name, reason in told[:_LISTED]:
        note(f"no column: {name!r} {reason}")
    if len(told) > _LISTED:
        note(f"no column: {len(told) - _LISTED} more")
    single = len(left_out) - len(told)
    if single:
        note(f"single numbers, which are no columns: {single}")


def _suggest(file: Path, found: hyst.io.FileSummary, how: dict[str, Any]) -> None:
    """Print the command that the guess amounts to, for a person to check, and try its reading."""
    guessed = {each.guess: each for each in found.columns if each.guess}
    if not {"input", "output"} <= set(guessed):
        return
    names = [text for each in found.columns for text in {each.name, each.header}]
    command = ["hyst", "identify", str(file)]
    for role, option in (("input", "--input"), ("output", "--output"), ("time", "--time")):
        if role in guessed:
            each = guessed[role]
            unique = [text for text in (each.name, each.header) if names.count(text) == 1]
            command += [option, unique[0] if unique else str(each.index)]
    if "time" not in guessed:
        command += ["--rate", "HZ"]
    for option in ("table", "format"):
        command += [] if how[option] is None else [f"--{option}", str(how[option])]
    print(f"\nif the guess is right: {shlex.join([*command, '-o', 'out'])}")
    columns = {role: each.index for role, each in guessed.items()}
    try:
        hyst.read_record(
            file,
            columns["input"],
            columns["output"],
            time=columns.get("time"),
            rate=None if "time" in columns else 1.0,
            **how,
        )
    except hyst.InputError as refusal:
        note(f"as it stands that is refused: {refusal}")
