"""hyst reproduce: the papers' numbers beside ours."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

import hyst
from hyst._files import replacing_files, require_folder
from hyst.cli.console import at_work, show_files, show_table
from hyst.cli.reading_options import may_read_records, read_told
from hyst.studies import keys, study

Which = Annotated[str, typer.Argument(metavar="[s0|..|all]", help="Which study.")]
Folder = Annotated[
    Path | None,
    typer.Option("-o", "--out", metavar="DIR", show_default=False, help="Write figures there."),
]


RecordFile = Annotated[
    Path | None,
    typer.Option(
        "--record",
        metavar="FILE",
        show_default=False,
        help="Make the study's comparison on this record instead; s2 has one.",
    ),
]
Validation = Annotated[
    Path | None,
    typer.Option(
        "--validate",
        metavar="FILE",
        show_default=False,
        help="With --record: another one, on which the fitted models are judged too.",
    ),
]
Delay = Annotated[
    float | None,
    typer.Option(
        metavar="N",
        show_default="identified",
        help="With --record: samples by which its output lags.",
    ),
]


@may_read_records
def reproduce(
    how: dict[str, Any],
    which: Which = "all",
    folder: Folder = None,
    record: RecordFile = None,
    validation: Validation = None,
    delay: Delay = None,
) -> None:
    """Compute the papers' tables again, and print them beside the papers' numbers."""
    if record is not None:
        if folder is not None:
            raise hyst.InputError("with --record there are no figures; leave out --out")
        _on_record(which, record, validation, delay, how)
        return
    about = {"validate": validation, "delay": delay, **how}
    for name in ("validate", "delay", "input", "output", "rate", "time"):
        if about[name] is None:
            continue
        raise hyst.InputError(f"--{name} is about a record; name it with --record, or leave it out")
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


def _on_record(
    which: str, record: Path, validation: Path | None, delay: float | None, how: dict[str, Any]
) -> None:
    """Make the comparison of a study on records of one's own."""
    able = [key for key in keys() if study(key).on_record is not None]
    compare = study(which).on_record if which != "all" else None
    if compare is None:
        raise hyst.InputError(f"{which} has no comparison for --record; choose {', '.join(able)}")
    for name in ("input", "output"):
        if how[name] is None:
            raise hyst.InputError(f"--record needs --{name}, the column of the {name}")
    files = [record] if validation is None else [record, validation]
    read = [_only(read_told(path, **how), path) for path in files]
    with at_work(f"comparing as {which} does"):
        tables = compare(read[0], read[1] if validation is not None else None, delay)
    for table in tables:
        show_table(table)


def _only(records: tuple[hyst.Record, ...], path: Path) -> hyst.Record:
    if len(records) > 1:
        raise hyst.InputError(f"--table all gives {len(records)} records of {path}; name one")
    return records[0]
