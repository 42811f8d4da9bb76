"""Read the numeric variables of a MATLAB level 4 file, the format before MATLAB 5."""

from __future__ import annotations

import struct

import numpy as np
from numpy.typing import NDArray

from hyst.io.entries import Contents

_HEADER = 20
_LONGEST_NAME = 64
_STORED = ("f8", "f4", "i4", "i2", "u2", "u1")
_NUMBERS, _TEXT = 0, 1


def read_mat4(data: memoryview, contents: Contents) -> None:
    """Find all arrays of a MATLAB level 4 file.

    Parameters
    ----------
    data
        Content of the file.
    contents
        Where to put them.

    Raises
    ------
    ValueError
        If the file is damaged or of another kind; the format has no mark to be known by.

    Source
    ------
    MathWorks, "MAT-File Format", chapter 2: level 4 MAT-files.
    """
    while data.nbytes:
        data = _variable(data, contents)


def _variable(data: memoryview, contents: Contents) -> memoryview:
    """Take up the first variable and give what follows it."""
    if data.nbytes < _HEADER:
        raise ValueError("level 4, a variable breaks off")
    order = "<" if struct.unpack_from("<i", data)[0] in range(5000) else ">"
    code, rows, columns, complex_, length = struct.unpack_from(order + "5i", data)
    machine, zero, stored, kind = (code // 1000, code // 100 % 10, code // 10 % 10, code % 10)
    if code < 0 or machine > 1 or zero or stored >= len(_STORED) or kind > 2 or rows < 0:
        raise ValueError("no mark of any version")
    if columns < 0 or complex_ not in {0, 1} or not 1 < length <= _LONGEST_NAME:
        raise ValueError("level 4, a variable has no size or no name")
    name = data[_HEADER : _HEADER + length].tobytes().split(b"\0")[0].decode("latin-1")
    dtype = np.dtype(order + _STORED[stored])
    size, start = rows * columns * dtype.itemsize, _HEADER + length
    end = start + size * (1 + complex_)
    if end > data.nbytes:
        raise ValueError("level 4, a variable is longer than the file")
    if kind == _NUMBERS:
        real = _matrix(data[start : start + size], dtype, rows)
        imaginary = _matrix(data[start + size : end], dtype, rows) if complex_ else None
        if imaginary is not None and imaginary.any():
            contents.left_out[name] = "is complex; save its real part, or its magnitude"
        else:
            contents.add(name, real)
    else:
        contents.left_out[name] = "is a text" if kind == _TEXT else "is sparse; save full(x)"
    return data[end:]


def _matrix(data: memoryview, dtype: np.dtype[np.generic], rows: int) -> NDArray[np.generic]:
    values = np.frombuffer(data, dtype=dtype)
    return values.reshape((rows, -1) if values.size else (rows, 0), order="F")
