"""Where the bytes come from: a file that grows, is cut off or replaced, or standard input."""

from __future__ import annotations

import os
import queue
import sys
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import hyst

_MOST = 1 << 20
_PIECE = 1 << 16
_WAITING_PIECES = 64
# So many bytes before the place that was read tell whether it is still the same file.
_REMEMBERED = 64
# A file made in advance ends with zeros; UTF-16 has up to three in a row.
_FEWEST_ZEROS = 4


@dataclass(frozen=True)
class Piece:
    """Some bytes of a source.

    Parameters
    ----------
    data
        What came.
    begins_file
        Whether another file begins here: it was cut off, or another one stands in its place.
    """

    data: bytes
    begins_file: bool = False


class GrowingFile:
    """Read what is written to a file, as ``tail -F`` does.

    Parameters
    ----------
    path
        The file, which need not exist yet.

    Raises
    ------
    InputError
        If it is a folder.
    """

    def __init__(self, path: Path) -> None:
        if path.is_dir():
            raise hyst.InputError(f"{path} is a folder; name a file, or - for standard input")
        self._path = path
        self._file: BinaryIO | None = None
        self._place = 0
        self._tail = b""
        self.is_there = False
        """Whether the file has ever been there."""
        self.is_over = False
        """Whether nothing can come any more; a file may always grow."""

    def read(self) -> Piece | None:
        """Give what has come; None if there is nothing new."""
        if self._file is None:
            return self._open()
        if self._is_another():
            self._begin(0)
            return Piece(b"", begins_file=True)
        data = self._read()
        if data:
            return Piece(data)
        return self._follow_name()

    def close(self) -> None:
        """Let the file go."""
        if self._file is not None:
            self._file.close()
            self._file = None

    def _open(self) -> Piece | None:
        try:
            self._file = self._path.open("rb")
        except FileNotFoundError:
            return None
        begins, self.is_there = self.is_there, True
        self._begin(0)
        return Piece(self._read(), begins_file=begins)

    def _begin(self, place: int) -> None:
        self._place, self._tail = place, b""

    def _is_another(self) -> bool:
        """Tell whether the file was cut off, or was and has grown again beyond the place read."""
        assert self._file is not None
        size = os.fstat(self._file.fileno()).st_size
        if size < self._place:
            return True
        if size == self._place or not self._tail:
            return False
        self._file.seek(self._place - len(self._tail))
        return self._file.read(len(self._tail)) != self._tail

    def _read(self) -> bytes:
        assert self._file is not None
        self._file.seek(self._place)
        data = self._file.read(_MOST)
        bare = data.rstrip(b"\0")
        if len(data) - len(bare) >= _FEWEST_ZEROS:
            data = data[: len(bare) + len(bare) % 2]
        self._place += len(data)
        self._tail = (self._tail + data)[-_REMEMBERED:]
        return data

    def _follow_name(self) -> Piece | None:
        """Go on with the file that has the name now, once the old one is read to its end."""
        assert self._file is not None
        try:
            named = self._path.stat()
        except FileNotFoundError:
            return None
        own = os.fstat(self._file.fileno())
        if (named.st_ino, named.st_dev) == (own.st_ino, own.st_dev):
            return None
        self._file.close()
        self._file = None
        return self._open()


class StandardInput:
    """Read standard input in a thread of its own, so that waiting for it can end."""

    def __init__(self, stream: BinaryIO | None = None) -> None:
        self._stream = sys.stdin.buffer if stream is None else stream
        self._pieces: queue.Queue[bytes] = queue.Queue(_WAITING_PIECES)
        self.is_there = True
        """As of ``GrowingFile``."""
        self.is_over = False
        """Whether it has ended."""
        threading.Thread(target=self._pass_on, daemon=True).start()

    def read(self) -> Piece | None:
        """Give all that has come; None if there is nothing new."""
        pieces: list[bytes] = []
        while len(pieces) < _WAITING_PIECES:
            try:
                data = self._pieces.get_nowait()
            except queue.Empty:
                break
            if not data:
                self.is_over = True
                break
            pieces.append(data)
        return Piece(b"".join(pieces)) if pieces else None

    def close(self) -> None:
        """Leave it to its thread, which ends with the program."""

    def _pass_on(self) -> None:
        read = getattr(self._stream, "read1", self._stream.read)
        data = b"more"
        while data:
            try:
                data = read(_PIECE)
            except (OSError, ValueError):
                data = b""
            self._pieces.put(data)


Source = GrowingFile | StandardInput


def source_of(name: str) -> Source:
    """Give the source of a name; ``-`` is standard input.

    Raises
    ------
    InputError
        If it is a folder.
    """
    return StandardInput() if name == "-" else GrowingFile(Path(name))
