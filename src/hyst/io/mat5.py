"""Read the numeric variables of a MATLAB level 5 file (versions 5 to 7).

SciPy's reader indexes a table with an unchecked byte of the file, so that one flipped bit can
crash the interpreter instead of raising. This one checks every length and type it meets, and
needs nothing but NumPy. Invariant: no slice reaches past the element it was cut from.
"""

from __future__ import annotations

import functools
import math
import struct
import zlib
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.io.entries import Contents, Selector, Stored
from hyst.io.mat_objects import object_refused

_HEADER = 128
_MATRIX, _COMPRESSED = 14, 15
_STORED = {
    1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8",
}  # fmt: skip
_CELL, _STRUCT, _OBJECT, _TEXT, _SPARSE, _NUMBERS = 1, 2, 3, 4, 5, range(6, 16)
_FUNCTION, _OPAQUE = 16, 17
_COMPLEX = 0x800
_COMPLEX_REFUSED = "is complex; save its real part, or its magnitude"
# Tag, flags, shape and name of an array fit into this.
_HEAD = 1024


@dataclass(frozen=True)
class _Head:
    """What an array says of itself before its values."""

    kind: int
    complex: bool
    shape: tuple[int, ...]
    name: str
    rest: memoryview


def is_mat5(data: memoryview) -> bool:
    """Tell whether a file is MATLAB level 5, by the version and byte order that end its header."""
    return data[_HEADER - 4 : _HEADER].tobytes() in {b"\x00\x01IM", b"\x01\x00MI"}


def read_mat5(data: memoryview, contents: Contents, most: int) -> None:
    """Find all arrays of a MATLAB level 5 file.

    Those of structs are named ``s.field`` or ``s(2).field``, those of cells ``c{1}``.

    Parameters
    ----------
    data
        Content of the file.
    contents
        Where to put them.
    most
        Bytes that a struct or cell may take when it is decompressed.

    Raises
    ------
    ValueError, zlib.error, RecursionError
        If the file is damaged.

    Source
    ------
    MathWorks, "MAT-File Format", chapter 1: level 5 MAT-files.
    """
    order = "<" if data[_HEADER - 2 : _HEADER].tobytes() == b"IM" else ">"
    rest = data[_HEADER:]
    while rest.nbytes:
        kind, payload, rest = _element(rest, order)
        if kind == _COMPRESSED and _put_off(payload, order, contents):
            continue
        if kind == _COMPRESSED:
            kind, payload, _ = _element(_inflate(payload, most), order)
        if kind == _MATRIX:
            _matrix(payload, order, None, contents)


def _put_off(payload: memoryview, order: str, contents: Contents) -> bool:
    """Take up a compressed array of real numbers by its head, to be decompressed when wanted."""
    start = memoryview(zlib.decompressobj().decompress(payload, _HEAD))
    try:
        head = _head(start[8:], order)
    except (ValueError, struct.error):
        return False
    if head.kind not in _NUMBERS or head.complex or not head.name:
        return False
    most = 8 * math.prod(head.shape) + _HEAD

    @functools.cache
    def array() -> NDArray[np.generic]:
        kind, whole, _ = _element(_inflate(payload, most), order)
        if kind != _MATRIX:
            raise ValueError(f"{head.name} is no array")
        return _values(_head(whole, order), order)[0]

    def read(selector: Selector) -> NDArray[np.generic]:
        return array()[selector]

    contents.arrays[head.name] = Stored(head.shape, read)
    return True


def _inflate(payload: memoryview, most: int) -> memoryview:
    inflater = zlib.decompressobj()
    data = memoryview(inflater.decompress(payload, most))
    if not inflater.eof and inflater.unconsumed_tail:
        raise ValueError(f"compressed data hold more than the {most} bytes expected")
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


def _text(data: memoryview, order: str) -> tuple[str, memoryview]:
    _, payload, rest = _element(data, order)
    return payload.tobytes().decode("utf-8", "replace"), rest


def _head(data: memoryview, order: str) -> _Head:
    """Read flags, shape and name; objects that are laid out in another way have no shape."""
    flags, data = _numbers(data, order)
    if flags.size != 2:
        raise ValueError("an array has no flags")
    kind, complex_ = int(flags[0]) & 0xFF, bool(int(flags[0]) & _COMPLEX)
    if kind >= _FUNCTION:
        return _Head(kind, False, (), "", data)
    shape, data = _numbers(data, order)
    sizes = tuple(int(size) for size in shape)
    if min(sizes, default=-1) < 0:
        raise ValueError(f"an array has the shape {list(sizes)}")
    name, data = _text(data, order)
    return _Head(kind, complex_, sizes, name, data)


def _matrix(data: memoryview, order: str, path: str | None, contents: Contents) -> None:
    """Add an array, or what a struct or cell holds, under ``path`` or else its own name."""
    if not data.nbytes:
        return
    head = _head(data, order)
    if head.kind >= _FUNCTION:
        _refuse_object(head, order, path, contents)
        return
    path = head.name if path is None else path
    if not path:
        return  # where MATLAB keeps the workings of its objects
    if head.kind == _STRUCT:
        _fields(head, order, path, contents)
    elif head.kind == _CELL:
        rest = head.rest
        for k in range(math.prod(head.shape)):
            rest = _nested(rest, order, f"{path}{{{k + 1}}}", contents)
    elif head.kind in _NUMBERS:
        values, imaginary = _values(head, order)
        if imaginary is not None and imaginary.any():
            contents.left_out[path] = _COMPLEX_REFUSED
        else:
            contents.add(path, values)
    elif head.kind == _TEXT:
        contents.texts[path] = _characters(head.rest, order)
    elif head.kind == _SPARSE:
        contents.left_out[path] = "is sparse; save full(x)"
    elif head.kind == _OBJECT:
        contents.left_out[path] = object_refused(path, _text(head.rest, order)[0])


def _values(head: _Head, order: str) -> tuple[NDArray[np.generic], NDArray[np.generic] | None]:
    """Read the real and, where there is one, the imaginary part of an array of numbers."""
    parts, rest = [], head.rest
    for _ in range(1 + head.complex):
        values, rest = _numbers(rest, order)
        if math.prod(head.shape) != values.size:
            raise ValueError(
                f"{head.name or 'an array'} has {values.size} values and the shape "
                f"{list(head.shape)}"
            )
        parts.append(values.reshape(head.shape, order="F"))
    return parts[0], parts[1] if head.complex else None


def _characters(data: memoryview, order: str) -> str:
    """Read a text, whose characters are stored as bytes or as units of UTF-16."""
    kind, payload, _ = _element(data, order)
    wide = "utf-16-le" if order == "<" else "utf-16-be"
    return payload.tobytes().decode(wide if kind in {4, 17} else "utf-8", "replace")


def _nested(data: memoryview, order: str, path: str, contents: Contents) -> memoryview:
    """Add the first array of several and give what follows it."""
    kind, payload, rest = _element(data, order)
    if kind != _MATRIX:
        raise ValueError(f"{path} is no array")
    _matrix(payload, order, path, contents)
    return rest


def _fields(head: _Head, order: str, path: str, contents: Contents) -> None:
    width, data = _numbers(head.rest, order)
    _, names, data = _element(data, order)
    if width.size != 1 or int(width[0]) < 1:
        raise ValueError(f"{path} has no length of field names")
    step, count = int(width[0]), math.prod(head.shape)
    stored = [names[start : start + step].tobytes() for start in range(0, names.nbytes, step)]
    labels = [label.split(b"\0")[0].decode("utf-8", "replace") for label in stored]
    if not labels:
        return
    for k in range(count):
        element = path if count == 1 else f"{path}({k + 1})"
        for label in labels:
            data = _nested(data, order, f"{element}.{label}", contents)


def _refuse_object(head: _Head, order: str, path: str | None, contents: Contents) -> None:
    """Say what an object is; what it holds is laid out in a way that is not published."""
    if head.kind != _OPAQUE:
        return
    name, rest = _text(head.rest, order)
    _, rest = _text(rest, order)
    path = name if path is None else path
    if path:
        contents.left_out[path] = object_refused(path, _text(rest, order)[0])
