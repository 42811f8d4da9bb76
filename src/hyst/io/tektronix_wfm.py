"""Read the waveform files of Tektronix oscilloscopes (``.wfm``)."""

from __future__ import annotations

import functools
import mmap
import struct
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.io.entries import Entry, Wanted, table_of_entries
from hyst.io.table import Table

SUFFIXES = (".wfm",)
_ORDERS = {b"\x0f\x0f": "<", b"\xf0\xf0": ">"}
_VERSIONS = (b":WFM#001", b":WFM#002", b":WFM#003")
# Code of the explicit dimension's format, with the bytes a point takes.
_FORMATS = {
    (0, 2): "i2", (1, 4): "i4", (2, 4): "u4", (3, 8): "u8", (4, 4): "f4", (5, 8): "f8",
    (6, 1): "u1", (7, 1): "i1",
}  # fmt: skip
_FROM_SUMMARY = 154  # version 1 lacks the two bytes here
_EXPLICIT, _IMPLICIT = 100, 76  # bytes of a description, without the user's view of it
_VECTOR = 2


def read_wfm(path: Path, wanted: Wanted) -> Table:
    """Read the record of a Tektronix waveform file, versions 1 to 3.

    Parameters
    ----------
    path
        The file.
    wanted
        Which columns to read, and how many numbers at most.

    Returns
    -------
    Table
        ``time`` and ``value``, with their units.

    Raises
    ------
    InputError
        If the file is damaged or of another kind, holds anything but one record of samples, or
        more than is allowed.

    Source
    ------
    Tektronix, "Performance Oscilloscope Reference Waveform File Format", 077-0220-11.
    """
    with path.open("rb") as file:
        data = memoryview(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ))
    order = _ORDERS.get(data[:2].tobytes())
    version = data[2:10].tobytes()
    if order is None or version not in _VERSIONS:
        raise InputError(
            f"{path} is damaged or no Tektronix waveform of version 1 to 3; save it again, or "
            "save as CSV"
        )
    try:
        entries = _record(data, order, _VERSIONS.index(version) + 1)
    except struct.error:
        raise InputError(f"{path} is damaged: it breaks off in its header; save it again") from None
    except ValueError as error:
        raise InputError(
            f"{path} is damaged or no plain record ({error}); save it again, or save as CSV"
        ) from error
    return table_of_entries(str(path), entries, wanted)


def _record(data: memoryview, order: str, version: int) -> list[Entry]:
    explicit = _FROM_SUMMARY + (14 if version > 1 else 12)
    view = 60 if version == 3 else 56
    implicit = explicit + 2 * (_EXPLICIT + view)
    time_bases = implicit + 2 * (_IMPLICIT + view)
    curve = time_bases + 48

    def number(kind: str, offset: int) -> float:
        return float(struct.unpack_from(order + kind, data, offset)[0])

    frames, record_kind = number("I", 72), number("I", 122)
    if frames:
        raise ValueError(f"{frames + 1:.0f} frames; save one")
    if record_kind != _VECTOR or number("I", 114) != 1 or number("I", 118) != 1:
        raise ValueError("no samples of one signal over time")
    width = int(number("B", 15))
    kind = _FORMATS.get((int(number("i", explicit + 72)), width))
    if kind is None or number("I", explicit + 76) != 0:
        raise ValueError("samples of a kind that is not known")
    start, end = int(number("I", curve + 14)), int(number("I", curve + 18))
    offset, count = int(number("i", 16)), (end - start) // width
    # An element of the size the header says, and not one more.
    if offset < curve + 30 or not 0 <= start < end or offset + end > data.nbytes:
        raise ValueError("its samples lie beyond its end")
    scale, shift = number("d", explicit), number("d", explicit + 8)
    step, first = number("d", implicit), number("d", implicit + 8)
    if not (np.isfinite([scale, shift, step, first]).all() and step > 0.0 and scale != 0.0):
        raise ValueError("no scale of the values or no time step")
    samples = data[offset + start : offset + start + count * width]
    dtype = np.dtype(order + kind)
    return [
        Entry(
            "time",
            "time",
            _unit(data, implicit + 20) or "s",
            count,
            functools.partial(_even, first, step, count),
        ),
        Entry(
            "value",
            "value",
            _unit(data, explicit + 20),
            count,
            functools.partial(_scaled, samples, dtype, scale, shift),
        ),
    ]


def _unit(data: memoryview, offset: int) -> str:
    stored = data[offset : offset + 20].tobytes().split(b"\0")[0]
    return stored.decode("latin-1").strip()


def _even(first: float, step: float, count: int) -> NDArray[np.float64]:
    return first + step * np.arange(count, dtype=np.float64)


def _scaled(
    samples: memoryview, dtype: np.dtype[np.generic], scale: float, shift: float
) -> NDArray[np.float64]:
    return np.frombuffer(samples, dtype=dtype).astype(np.float64) * scale + shift
