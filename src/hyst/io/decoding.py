"""Bytes of a text file to lines."""

from __future__ import annotations

import codecs
import re

from hyst.errors import InputError

_CONTROL = re.compile(r"[\x00-\x08\x0e-\x1f\x7f]")
_HEAD = 4096
_FEW, _MANY = 0.05, 0.7
_BYTE_ORDER_MARKS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)


def decode(data: bytes, source: str) -> str:
    r"""Decode UTF-8 or UTF-16, with a byte order mark or without, else Latin-1.

    What pads the end of a file that was made in advance, bytes of zero, is dropped.

    Parameters
    ----------
    data
        Content of the file.
    source
        Name of the file, for messages.

    Returns
    -------
    str
        The text, lines ended by a line feed.

    Raises
    ------
    InputError
        If the file holds control characters, as binary files do, or breaks the encoding its
        byte order mark announces.

    Examples
    --------
    >>> decode(b"t [\xb5s]\r\n1\r\n", "a.csv")
    't [µs]\n1\n'
    """
    # DOS editors end a file with this mark.
    text = _decoded(data, source).rstrip("\x00").removesuffix("\x1a")
    # Spreadsheets set to Nordic and some other languages write the sign of mathematics.
    text = text.replace("\N{MINUS SIGN}", "-")
    control = _CONTROL.search(text)
    if control:
        line = text.count("\n", 0, control.start()) + 1
        raise InputError(
            f"{source} is not a text file: it holds the control character "
            f"{ord(control[0]):#04x} at line {line}; give it the suffix of its real format"
        )
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _decoded(data: bytes, source: str) -> str:
    for mark, encoding in _BYTE_ORDER_MARKS:
        if data.startswith(mark):
            try:
                return data[len(mark) :].decode(encoding)
            except UnicodeDecodeError as error:
                raise InputError(
                    f"{source} starts as {encoding} but breaks off at byte {error.start}; "
                    "save it again as UTF-8"
                ) from error
    unmarked = _utf_16_without_mark(data)
    if unmarked is not None:
        return data[: len(data) // 2 * 2].decode(unmarked, errors="replace")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def _utf_16_without_mark(data: bytes) -> str | None:
    """Recognise UTF-16: of text in Latin letters every other byte is zero."""
    head = data[:_HEAD].rstrip(b"\x00")
    even, odd = head[::2], head[1::2]
    if not odd:
        return None
    zeros = even.count(0) / len(even), odd.count(0) / len(odd)
    if min(zeros) > _FEW or max(zeros) < _MANY:
        return None
    return "utf-16-le" if zeros[1] > zeros[0] else "utf-16-be"
