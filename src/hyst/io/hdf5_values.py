"""The values of an HDF5 data set as they are meant: unpacked, and masked where there are none."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.io.entries import MOST_SAMPLES, Selector


class NotAllThere(Exception):  # noqa: N818  a reason, caught where it is raised
    """Why a data set is no column: a phrase that follows its name."""


def reading(
    item: Any, field: tuple[str, ...], turned: bool
) -> tuple[Callable[[Selector], NDArray[Any]], str]:
    """Give a function that reads a part of a data set, and what a gap in it is called.

    Parameters
    ----------
    item
        The data set.
    field
        The field of its compound type; empty if it has none.
    turned
        Whether its axes stand in reverse order.

    Raises
    ------
    NotAllThere
        If it holds no real numbers, or none that were ever written.
    """
    dtype = item.dtype[field[0]] if field else item.dtype
    if dtype.kind == "c":
        if field or item.size > MOST_SAMPLES or np.any(item[()].imag):
            raise NotAllThere("is complex; save its real part, or its magnitude")
    elif dtype.kind not in "biuf":
        raise NotAllThere("holds no numbers")
    holes = _has_holes(item)
    missing = () if field else _missing(item.attrs)
    packed = () if field else _packing(item.attrs)

    def read(selector: Selector) -> NDArray[Any]:
        chosen = selector[::-1] if turned else selector
        values = item.fields(field[0])[chosen] if field else item[chosen]
        if values.dtype.kind == "c":
            values = values.real
        gaps = np.zeros(values.shape, dtype=bool)
        if holes:
            gaps |= ~_written(item, chosen)
        for value in missing:
            gaps |= values == value
        if packed:
            values = values * packed[0] + packed[1]
        return np.ma.masked_array(values, gaps) if gaps.any() else values

    return read, ""


def stored_text(value: object) -> str:
    """Give an attribute as text; empty if it is none."""
    if isinstance(value, np.ndarray) and value.size == 1:
        value = value.item()
    if isinstance(value, bytes):
        return value.decode("utf-8", errors="replace")
    return str(value) if isinstance(value, str) else ""


def _missing(attributes: Any) -> tuple[float, ...]:
    """List the values that netCDF and its relatives write where there is none."""
    found: list[float] = []
    for name in ("_FillValue", "missing_value"):
        values = np.asarray(attributes.get(name, ()))
        if values.dtype.kind in "iuf":
            found += values.ravel().tolist()
    return tuple(found)


def _packing(attributes: Any) -> tuple[float, ...]:
    """Give scale and offset of packed numbers; nothing if they are stored as they are."""
    given = [np.asarray(attributes.get(name, ())) for name in ("scale_factor", "add_offset")]
    if not any(each.size == 1 and each.dtype.kind in "iuf" for each in given):
        return ()
    numbers = [
        float(each.item()) if each.size == 1 and each.dtype.kind in "iuf" else default
        for each, default in zip(given, (1.0, 0.0), strict=True)
    ]
    return tuple(numbers)


def _has_holes(item: Any) -> bool:
    """Tell whether parts of a data set were declared but never written."""
    if not item.size:
        return False
    if item.chunks is None:
        if item.id.get_storage_size() == 0 and not item.is_virtual:
            raise NotAllThere("was declared but never written")
        return False
    chunks = math.prod(-(-n // c) for n, c in zip(item.shape, item.chunks, strict=True))
    written = item.id.get_num_chunks()
    if written == 0:
        raise NotAllThere("was declared but never written")
    return bool(written < chunks)


def _written(item: Any, chosen: Selector) -> NDArray[np.bool_]:
    """Tell which samples along the one axis that is not fixed were ever written."""
    axis = next(k for k, each in enumerate(chosen) if isinstance(each, slice))
    rows = np.zeros(item.shape[axis], dtype=bool)

    def mark(chunk: Any) -> None:
        for k, (start, size) in enumerate(zip(chunk.chunk_offset, item.chunks, strict=True)):
            index = chosen[k]
            if isinstance(index, int) and not start <= index < start + size:
                return
        rows[chunk.chunk_offset[axis] :][: item.chunks[axis]] = True

    item.id.chunk_iter(mark)
    return rows[chosen[axis]]
