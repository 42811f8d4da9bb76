"""Records that stay in their file on the command line: when they do, and how they are opened."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

import hyst
from hyst.cli.console import note
from hyst.io.chunked import reads_in_chunks

LARGE = 256 * 2**20
"""Bytes of a file from which on its record stays in it: 16 million samples of two doubles."""

InFile = Annotated[
    str,
    typer.Option(
        metavar="yes|no|auto",
        help="Leave the record in its file: the constants are fitted to all of it, and what else "
        "there is to find on half a million samples; auto: where the file is larger than "
        f"{LARGE // 2**20} MB.",
    ),
]

_TO_OPEN = ("input", "output", "time", "rate", "time_unit", "dead_band", "format")
_NOT_SERVED = {
    "repair": "--repair",
    "table": "--table",
    "resample": "--resample",
    "hold_input": "--hold-input",
    "input_time": "--input-time",
    "output_time": "--output-time",
    "output_file": "--output-file",
}


@dataclass(frozen=True)
class FileToKeep:
    """Which record stays in its file, if any does.

    Parameters
    ----------
    paths
        The files of records.
    how
        Arguments of ``hyst.read_record``.
    others
        Further options that only records in memory serve, and what was typed, None if nothing.
    """

    paths: Sequence[Path]
    how: Mapping[str, Any]
    others: Mapping[str, object]

    def opened(self, asked: str) -> hyst.io.RecordFile | None:
        """Open it, or give None where records are to be read into memory.

        Parameters
        ----------
        asked
            ``yes``, ``no``, or ``auto`` to decide by its size.

        Raises
        ------
        InputError
            If it is to stay there, and there are several or an option that cannot be served; or it
            is asked for in another word.
        """
        if asked not in ("yes", "no", "auto"):
            raise hyst.InputError(f"--in-file is {asked!r}; give yes, no or auto")
        if asked == "no" or (asked == "auto" and not self._is_large()):
            return None
        if len(self.paths) > 1:
            raise hyst.InputError(
                f"{len(self.paths)} records are given, and only one can stay in its file; give "
                "one, or --in-file no"
            )
        for option, typed in self._not_served().items():
            if typed:
                raise hyst.InputError(
                    f"{option} is not for a record that stays in its file; give --in-file no, or "
                    "leave it out"
                )
        record = hyst.open_record(self.paths[0], **{each: self.how[each] for each in _TO_OPEN})
        for sentence in record.notes:
            note(f"{self.paths[0].name}: {sentence}")
        note(f"{self.paths[0].name}: its {len(record)} samples stay in the file")
        return record

    def _is_large(self) -> bool:
        return any(
            each.is_file()
            and each.stat().st_size > LARGE
            and reads_in_chunks(each, self.how["format"])
            for each in self.paths
        )

    def _not_served(self) -> dict[str, bool]:
        typed = {option: bool(self.how[name]) for name, option in _NOT_SERVED.items()}
        return typed | {option: given is not None for option, given in self.others.items()}


def shown(
    found: hyst.Identified, records: list[hyst.Record], kept: hyst.io.RecordFile | None
) -> list[hyst.Record]:
    """Give the records that figures can show: of one in its file the part that was judged."""
    if kept is None:
        return records
    part = found.part
    samples = slice(0, len(kept)) if part is None else slice(part.start, part.stop)
    return [hyst.identification.part_of(kept, samples)]
