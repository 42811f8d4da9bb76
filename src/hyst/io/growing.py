"""Rows of a text file that is still being written: bytes in, rows out."""

from __future__ import annotations

import codecs
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.io.decoding import decode
from hyst.io.fast_numbers import Body, parse_numbers
from hyst.io.growing_head import Head, Roles, find_head, number_of
from hyst.io.lvm import is_lvm
from hyst.io.stamps import seconds_of_stamps
from hyst.io.text_lines import COMMENTS
from hyst.io.unit_of_stamps import require_time_unit

Array = NDArray[np.float64]

# Rows by which the writing is judged, and how much may stand above them.
_ROWS = 8
_LONGEST_HEAD = 1 << 20
_LONGEST_LINE = 1 << 16
_DIGITS = b"0123456789+-eE \n"
_QUOTED = 60
# Bytes that tell an encoding.
_MARKS = 4


@dataclass(frozen=True, eq=False)
class Rows:
    """Rows of a file that have become whole.

    Parameters
    ----------
    u, y
        Shape (N,); NaN where there is no number.
    time
        Shape (N,), seconds as the file counts them; NaN where there is no stamp or no such column.
    unreadable
        Shape (N,): whether the line is no row of this file at all.
    """

    u: Array
    y: Array
    time: Array
    unreadable: NDArray[np.bool_]

    @property
    def size(self) -> int:
        """Number of rows."""
        return int(self.u.size)


def joined(parts: Sequence[Rows]) -> Rows:
    """Put rows one after the other."""
    if len(parts) == 1:
        return parts[0]
    names = ("u", "y", "time", "unreadable")
    whole = (np.concatenate([getattr(each, name) for each in (_NONE, *parts)]) for name in names)
    return Rows(*whole)


_NONE = Rows(np.empty(0), np.empty(0), np.empty(0), np.empty(0, dtype=np.bool_))


class GrowingRows:
    r"""Read a text file piece by piece, by the rules of ``read_text``.

    The first rows tell how it is written; a line that is not ended yet waits for the rest of it.
    What comes out does not depend on where the pieces are cut. A line that is no row counts as one
    row without values, for something was sampled there.

    Parameters
    ----------
    source
        Name of the file, for messages.
    roles
        The columns of ``input``, ``output`` and ``time``, as ``find_column`` takes them.
    time_unit
        Unit of the time; what the file says if left out.

    Raises
    ------
    InputError
        If the unit of time is unknown.

    Examples
    --------
    >>> rows = GrowingRows("a.csv", {"input": "u", "output": "y", "time": None})
    >>> rows.feed(b"u,y\n0,1\n2,").size, rows.feed(b"3\n4").size
    (0, 0)
    >>> rows.finish().y
    array([ 1.,  3., nan])
    >>> rows.unreadable, rows.first_unreadable
    (1, (4, '4'))
    """

    def __init__(self, source: str, roles: Roles, time_unit: str | None = None) -> None:
        require_time_unit(time_unit)
        self.source = source
        self.head: Head | None = None
        """How the rows are written, once that is known."""
        self.lines = 0
        """Lines of the present file that were taken in."""
        self.unreadable = 0
        """Lines that were no rows."""
        self.first_unreadable: tuple[int, str] | None = None
        """The first of them: its number and text."""
        self._roles, self._time_unit = dict(roles), time_unit
        self._before: Head | None = None
        self._begin()

    def _begin(self) -> None:
        self._decoder: codecs.IncrementalDecoder | None = None
        self._first: bytes | None = b""
        self._ends_with_return = False
        self._rest = b""
        self._is_skipping = False
        self._tried = _ROWS
        self._last_stamp = ""
        self._seconds = 0.0

    def feed(self, data: bytes) -> Rows:
        """Take in the next bytes.

        Parameters
        ----------
        data
            As many as there are.

        Returns
        -------
        Rows
            Those that became whole.

        Raises
        ------
        InputError
            If the file has no such columns, or a long head without rows, as of a binary file.
        """
        self._rest += self._decoded(data)
        if self.head is None:
            return self._from_head(self._rest[: self._end()])
        whole = self._rest[: self._end()]
        self._rest = self._rest[len(whole) :]
        if self._is_skipping and whole:
            whole, self._is_skipping = whole[whole.index(b"\n") + 1 :], False
        rows = self._rows(whole)
        return joined([rows, self._without_endless()])

    def finish(self) -> Rows:
        """Take what is left as the end of the file, a last line without an end too."""
        self._rest += self._decoded(b"", is_last=True)
        if self._rest and not self._rest.endswith(b"\n") and not self._is_skipping:
            self._rest += b"\n"
        if self.head is None:
            return self._from_head(self._rest, is_last=True)
        whole, self._rest = b"" if self._is_skipping else self._rest, b""
        return self._rows(whole)

    def restart(self) -> Rows:
        """End this file, for another one stands in its place; give what was left of it."""
        rows = self.finish()
        self._before, self.head, self.lines = self.head or self._before, None, 0
        self._begin()
        return rows

    def _decoded(self, data: bytes, is_last: bool = False) -> bytes:
        """Give bytes of UTF-8 or Latin-1 with line feeds, whatever the file has."""
        if self._first is not None:
            data = self._first + data
            self._first = data
            if len(data) < _MARKS and not is_last:
                return b""
            self._first = None
            if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
                self._decoder = codecs.getincrementaldecoder("utf-16")("replace")
            elif len(data) >= _MARKS and data[1:4:2] == b"\0\0":
                self._decoder = codecs.getincrementaldecoder("utf-16-le")("replace")
            data = data.removeprefix(codecs.BOM_UTF8)
        if self._decoder is not None:
            data = self._decoder.decode(data).removeprefix("\ufeff").encode()
        else:
            data = data.replace(b"\0", b"")
        if self.head is None and b"\n" not in self._rest + data:
            self._ends_with_return = b"\r" in (self._rest + data)[:-1]
        if self._ends_with_return:
            self._rest = self._rest.replace(b"\r", b"\n")
            return data.replace(b"\r", b"\n")
        return data

    def _end(self) -> int:
        return self._rest.rfind(b"\n") + 1

    def _without_endless(self) -> Rows:
        """Give up a line that does not end."""
        if len(self._rest) <= _LONGEST_LINE:
            return _NONE
        rows = _NONE
        if not self._is_skipping:
            self.lines += 1
            self._note_unreadable(self.lines, self._rest[:_QUOTED].decode("latin-1"))
            rows = _unreadable(1)
        self._rest, self._is_skipping = b"", True
        return rows

    def _from_head(self, whole: bytes, is_last: bool = False) -> Rows:
        """Find the head in as few lines as tell it; until then, everything is kept."""
        taken = len(whole)
        whole = _with_line_feeds(whole)
        lines = whole.count(b"\n")
        while self._tried <= lines:
            head = self._head_of(whole, self._tried, _ROWS)
            if head is not None:
                return self._beyond_head(whole, head, taken)
            self._tried += self._tried // 4
        head = self._head_of(whole, lines, 1) if is_last and lines else None
        if head is not None:
            return self._beyond_head(whole, head, taken)
        if len(self._rest) > _LONGEST_HEAD:
            raise InputError(
                f"{self.source} holds no rows of numbers in its first {len(self._rest)} bytes; "
                "give a text file with columns of numbers"
            )
        return _NONE

    def _head_of(self, whole: bytes, lines: int, rows: int) -> Head | None:
        first = b"".join(whole.splitlines(keepends=True)[:lines])
        text = decode(first, self.source)
        if is_lvm(text):
            raise InputError(
                f"{self.source} is a LabVIEW measurement file, whose segments cannot be followed; "
                "let the logger write a plain table"
            )
        return find_head(text, self.source, self._roles, self._time_unit, rows, self._before)

    def _beyond_head(self, whole: bytes, head: Head, taken: int) -> Rows:
        self.head = head
        self._rest = self._rest[taken:]
        self.lines += head.first_line - 1
        return self._rows(b"".join(whole.splitlines(keepends=True)[head.first_line - 1 :]))

    def _rows(self, whole: bytes) -> Rows:
        """Read whole lines, at the speed of C where they are numbers alone."""
        if not whole:
            return _NONE
        assert self.head is not None
        whole = _with_line_feeds(whole)
        fast = self._by_numbers(whole, self.head)
        if fast is not None:
            self.lines += fast.size
            return fast
        return self._by_cells(whole, self.head)

    def _by_numbers(self, whole: bytes, head: Head) -> Rows | None:
        writing = head.writing
        separator = (writing.separator or "\t").encode()
        if head.are_stamps or writing.decimal == writing.separator:
            return None
        if whole.startswith(b"\n") or b"\n\n" in whole:
            return None
        if whole.translate(None, _DIGITS + separator + writing.decimal.encode()):
            return None
        if head.trailing:
            whole = whole.replace(separator + b"\n", b"\n")
        if writing.decimal == ",":
            whole = whole.replace(b",", b".")
        body = Body(whole, 0, len(whole) - 1)
        values = parse_numbers(body, head.count, writing.separator, head.columns)
        if values is None or not np.isfinite(values[list(head.columns)]).all():
            return None
        u, y = (np.ascontiguousarray(values[k]) for k in head.columns[:2])
        time = values[head.columns[2]] * head.seconds if len(head.columns) > 2 else _nan(u.size)
        return Rows(u, y, time, np.zeros(u.size, dtype=np.bool_))

    def _by_cells(self, whole: bytes, head: Head) -> Rows:
        """Read line by line; what cannot be read is counted."""
        try:
            text = whole.decode()
        except UnicodeDecodeError:
            text = whole.decode("latin-1")
        values: list[tuple[float, float, float]] = []
        unreadable: list[bool] = []
        lines = text.split("\n")[:-1]
        for k, line in enumerate(lines):
            bare = line.strip()
            if not bare or bare.startswith(COMMENTS) or bare in head.above:
                self.lines += 1
                continue
            row = self._row(line, head)
            if row is None and head.names_the_columns(line):
                return joined([_of_lists(values, unreadable), self._again(lines[k:])])
            self.lines += 1
            if row is None:
                self._note_unreadable(self.lines, bare)
            values.append(row or (np.nan, np.nan, np.nan))
            unreadable.append(row is None)
        return _of_lists(values, unreadable)

    def _again(self, lines: list[str]) -> Rows:
        """Go on from a header that stands among the rows with its columns in another order."""
        self._before, self.head, self._tried = self.head, None, _ROWS
        self._rest = ("\n".join(lines) + "\n").encode() + self._rest
        return self._from_head(self._rest[: self._end()])

    def _row(self, line: str, head: Head) -> tuple[float, float, float] | None:
        """Read input, output and time of a line; None if it is no row."""
        if head.trailing:
            line = line.rstrip().removesuffix(head.writing.separator or "")
        cells = head.writing.cells(line)
        if len(cells) != head.count:
            return None
        decimal = head.writing.decimal
        u, y = (number_of(cells[k], decimal) for k in head.columns[:2])
        time: float | None = np.nan
        if head.are_stamps:
            time = self._seconds_of(cells, head)
        elif len(head.columns) > 2:
            time = number_of(cells[head.columns[2]], decimal)
            time = None if time is None else time * head.seconds
        if u is None or y is None or time is None:
            return None
        return u, y, time

    def _seconds_of(self, cells: list[str], head: Head) -> float | None:
        """Count the seconds from stamp to stamp."""
        stamp = cells[head.columns[2]]
        if head.clock is not None:
            stamp = f"{stamp} {cells[head.clock]}"
        found = seconds_of_stamps([self._last_stamp or stamp, stamp])
        if found.flaw is not None:
            return None
        self._last_stamp = stamp
        self._seconds += float(found.seconds[1])
        return self._seconds

    def _note_unreadable(self, line: int, text: str) -> None:
        self.unreadable += 1
        if self.first_unreadable is None:
            self.first_unreadable = (line, text if len(text) <= _QUOTED else text[:_QUOTED] + "...")


def _with_line_feeds(whole: bytes) -> bytes:
    if b"\r" not in whole:
        return whole
    return whole.replace(b"\r\n", b"\n").replace(b"\r", b"\n")


def _nan(count: int) -> Array:
    return np.full(count, np.nan)


def _unreadable(count: int) -> Rows:
    return Rows(_nan(count), _nan(count), _nan(count), np.ones(count, dtype=np.bool_))


def _of_lists(values: list[tuple[float, float, float]], unreadable: list[bool]) -> Rows:
    if not values:
        return _NONE
    u, y, time = (np.array(each) for each in zip(*values, strict=True))
    return Rows(u, y, time, np.array(unreadable, dtype=np.bool_))
