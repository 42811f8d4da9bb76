"""A record in a file, read in chunks as often as it is wanted."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import whole_number
from hyst.errors import InputError
from hyst.io.chunked.pieces import Columns, regroup
from hyst.io.chunked.survey import Survey, checked
from hyst.io.reading import read_record
from hyst.signals import Record

_MOST = 10**12


@dataclass(frozen=True, eq=False)
class RecordFile:
    """A record that stays in its file; ``open_record`` makes one.

    The file is opened anew for each way through it, so that this object holds no file and can go
    to another process.

    Parameters
    ----------
    path
        The file.
    columns
        How it is read.
    found
        What the first way through it found.
    how
        The options of ``read_record`` that read the same.
    version
        Size and time of the last change of the file when it was checked, ``version_of``.

    Raises
    ------
    InputError
        While it is read, if the file has changed since it was checked.
    """

    path: Path
    columns: Columns
    found: Survey
    how: Mapping[str, Any]
    version: tuple[int, int]

    def __len__(self) -> int:
        """Give the number of samples N."""
        return self.found.samples

    @property
    def dt(self) -> float:
        """Time between samples, s."""
        return self.found.dt

    @property
    def input_name(self) -> str:
        """Name of the input."""
        return self.columns.table.names[self.found.columns[0]]

    @property
    def output_name(self) -> str:
        """Name of the output."""
        return self.columns.table.names[self.found.columns[1]]

    @property
    def u_unit(self) -> str:
        """Unit of the input as text; empty if unknown."""
        return self.columns.table.units[self.found.columns[0]]

    @property
    def y_unit(self) -> str:
        """Unit of the output as text; empty if unknown."""
        return self.columns.table.units[self.found.columns[1]]

    @property
    def notes(self) -> tuple[str, ...]:
        """What was found out about the file, one sentence each."""
        return self.found.notes

    def chunks(self, samples: int) -> Iterator[tuple[NDArray[np.float64], NDArray[np.float64]]]:
        """Read the record from its start, so many samples at a time.

        Parameters
        ----------
        samples
            How many in each chunk, >= 1; the last one may be shorter.

        Yields
        ------
        tuple of numpy.ndarray
            Input and output, float64, finite, shape (samples,); new arrays each time.

        Raises
        ------
        InputError
            If ``samples`` is no whole number >= 1, or the file has changed since it was opened:
            its size, or the time of its last change.
        """
        length = whole_number(samples, "samples", 1, _MOST)
        return self._chunks(length)

    def load(self) -> Record:
        """Read the whole record at once, as ``read_record`` does, and as the file is now.

        Raises
        ------
        InputError, MissingExtraError
            As ``read_record``.
        """
        return read_record(self.path, **self.how, max_samples=_MOST)

    def _chunks(self, samples: int) -> Iterator[tuple[NDArray[np.float64], NDArray[np.float64]]]:
        # Before anything is read: columns may have changed places, and nobody would see it.
        self._require_unchanged()
        given = 0
        for u, y in regroup(self._pieces(), samples, len(self)):
            given += u.size
            yield u, y
        if given != len(self):
            raise self._changed()

    def _pieces(self) -> Iterator[tuple[NDArray[np.float64], ...]]:
        chosen, read = list(self.found.columns), 0
        for piece in self.columns.pieces(chosen):
            self._require_unchanged()
            checked(self.columns.table, piece, chosen)
            read += piece.size
            if read > len(self):
                raise self._changed()
            yield piece.values

    def _require_unchanged(self) -> None:
        if version_of(self.path) != self.version:
            raise self._changed()

    def _changed(self) -> InputError:
        return InputError(
            f"{self.path} has changed since its {len(self)} samples were checked; open it again"
        )


def version_of(path: Path) -> tuple[int, int]:
    """Give size and time of the last change of a file, bytes and ns.

    Raises
    ------
    InputError
        If there is no such file.
    """
    try:
        now = path.stat()
    except FileNotFoundError:
        raise InputError(f"{path} does not exist; check the path") from None
    return now.st_size, now.st_mtime_ns
