"""Read the numeric variables of a MATLAB level 5 file (versions 5 to 7).

SciPy's reader indexes a table with an unchecked byte of the file, so that one flipped bit can
crash the interpreter instead of raising. This one checks every length and type it meets, and
needs nothing but NumPy. Invariant: no slice reaches past the element it was cut from.
"""

from __future__ import annotations

import math
import struct
import zlib

import numpy as np
from numpy.typing import NDArray

_HEADER = 128
_MATRIX, _COMPRESSED = 14, 15
_STORED = {
    1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8",
}  # fmt: skip
_STRUCT, _NUMBERS, _FUNCTION = 2, range(6, 16), range(16, 256)
_COMPLEX = 0x800

Arrays = dict[str, NDArray[np.generic]]


def is_mat5(data: bytes) -> bool:
    """Tell whether a file is MATLAB level 5, by the version and byte order that end its header."""
    return data[_HEADER - 4 : _HEADER] in {b"\x00\x01IM", b"\x01\x00MI"}


def read_mat5(data: bytes) -> Arrays:
    """Read all real numeric arrays of a MATLAB level 5 file.

    Parameters
    ----------
    data
        Content of the file.

    Returns
    -------
    dict
        Arrays by name; those in a struct of size 1 are named ``struct.field``. Complex and
        sparse arrays, texts, cells, objects and functions are left out.

    Raises
    ------
    ValueError, zlib.error, RecursionError
        If the file is damaged.

    Source
    ------
    MathWorks, "MAT-File Format", chapter 1: level 5 MAT-files.
    """
    order = "<" if data[_HEADER - 2 : _HEADER] == b"IM" else ">"
    arrays: Arrays = {}
    rest = memoryview(data)[_HEADER:]
    while rest.nbytes:
        kind, payload, rest = _element(rest, order)
        if kind == _COMPRESSED:
            kind, payload, _ = _element(_inflate(payload), order)
        if kind == _MATRIX:
            _matrix(payload, order, None, arrays)
    return arrays


def _inflate(payload: memoryview) -> memoryview:
    inflater = zlib.decompressobj()
    data = memoryview(inflater.decompress(payload))
    # Only at its end does the stream say whether what came before is what was written.
    if not inflater.eof:
        raise ValueError("compressed data break off")
    return data


def _element(data: memoryview, order: str) -> tuple[int, memoryview, memoryview]:
    """Cut off the first element: its type, its content, and what follows it."""
    if data.nbytes < 8:
        raise ValueError("an element breaks off in its tag")
    kind, size = struct.unpack_from(order + "II", data)
    start = 8
    if kind >> 16:  # up to 4 bytes are packed into the tag
        kind, size, start = kind & 0xFFFF, kind >> 16, 4
        padded = 4
    else:
        padded = size if kind == _COMPRESSED else size + -size % 8
    if size > padded or start + size > data.nbytes:
        raise ValueError("an element is longer than the file")
    return kind, data[start : start + size], data[start + padded :]


def _numbers(data: memoryview, order: str) -> tuple[NDArray[np.generic], memoryview]:
    """Cut off an element of numbers."""
    kind, payload, rest = _element(data, order)
    if kind not in _STORED:
        raise ValueError(f"type {kind} is no type of number")
    return np.frombuffer(payload, dtype=order + _STORED[kind]), rest


def _text(data: memoryview, order: str) -> tuple[bytes, memoryview]:
    _, payload, rest = _element(data, order)
    return payload.tobytes(), rest


def _matrix(data: memoryview, order: str, name: str | None, arrays: Arrays) -> None:
    """Add an array, or the fields of a struct, under ``name`` or else the name it states."""
    if not data.nbytes:
        return
    flags, data = _numbers(data, order)
    if flags.size != 2:
        raise ValueError("an array has no flags")
    flag = int(flags[0])
    if (flag & 0xFF) in _FUNCTION:
        return  # laid out in another way, and never data
    shape, data = _numbers(data, order)
    stated, data = _text(data, order)
    name = stated.decode("utf-8", "replace") if name is None else name
    if not name:
        return  # where MATLAB keeps the workings of its objects
    if (flag & 0xFF) == _STRUCT and math.prod(shape.tolist()) == 1:
        _fields(data, order, name, arrays)
    elif (flag & 0xFF) in _NUMBERS and not flag & _COMPLEX:
        values, _ = _numbers(data, order)
        if min(shape.tolist(), default=-1) < 0 or math.prod(shape.tolist()) != values.size:
            raise ValueError(f"{name} has {values.size} values and the shape {shape.tolist()}")
        arrays[name] = values.reshape(shape.tolist(), order="F")


def _fields(data: memoryview, order: str, name: str, arrays: Arrays) -> None:
    width, data = _numbers(data, order)
    labels, data = _text(data, order)
    if width.size != 1 or int(width[0]) < 1:
        raise ValueError(f"{name} has no length of field names")
    step = int(width[0])
    for start in range(0, len(labels), step):
        label = labels[start : start + step].split(b"\0")[0].decode("utf-8", "replace")
        kind, payload, data = _element(data, order)
        if kind != _MATRIX:
            raise ValueError(f"{name}.{label} is no array")
        _matrix(payload, order, f"{name}.{label}", arrays)
