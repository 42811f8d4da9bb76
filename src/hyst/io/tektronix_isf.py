"""Read the internal files of Tektronix oscilloscopes (``.isf``): a preamble and a curve."""

from __future__ import annotations

import functools
import mmap
import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.io.entries import Entry, Wanted, table_of_entries
from hyst.io.table import Table

SUFFIXES = (".isf",)
_LONGEST_PREAMBLE = 4096
_CURVE = re.compile(rb":?CURVE?\s+", re.IGNORECASE)
_FIELD = re.compile(r'([A-Z_.]+)\s+("[^"]*"|[^;]*)', re.IGNORECASE)
# Long and short forms of the words that are needed, each with its least number of letters.
_WORDS = {
    "BYT_NR": "width", "BYT_N": "width", "BYT_NUM": "width", "ENCDG": "encoding", "ENC": "encoding",
    "ENCDGE": "encoding", "ENCODING": "encoding", "BN_FMT": "format", "BN_F": "format",
    "BYT_OR": "order", "BYT_O": "order", "NR_PT": "count", "NR_P": "count",
    "PT_FMT": "points", "PT_F": "points", "XINCR": "step", "XIN": "step",
    "XZERO": "start", "XZE": "start", "XUNIT": "x_unit", "XUN": "x_unit",
    "PT_OFF": "trigger", "PT_O": "trigger",
    "YMULT": "scale", "YMU": "scale", "YZERO": "zero", "YZE": "zero", "YOFF": "shift",
    "YOF": "shift", "YUNIT": "unit", "YUN": "unit", "WFID": "label", "WFI": "label",
}  # fmt: skip


def read_isf(path: Path, wanted: Wanted) -> Table:
    """Read the record of a Tektronix ISF file.

    Parameters
    ----------
    path
        The file.
    wanted
        Which columns to read, and how many numbers at most.

    Returns
    -------
    Table
        ``time``, and the channel by its name.

    Raises
    ------
    InputError
        If the file is damaged or of another kind, holds envelopes (pairs of extremes) or several
        curves, or more than is allowed.

    Source
    ------
    Tektronix, "TDS3000, TDS3000B, TDS3000C Series Programmer Manual", 071-0381: WFMPRe and CURVe.
    """
    with path.open("rb") as file:
        data = memoryview(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ))
    try:
        entries = _record(data)
    except ValueError as error:
        raise InputError(
            f"{path} is damaged or no ISF file ({error}); save it again, or save as CSV"
        ) from error
    return table_of_entries(str(path), entries, wanted)


def _record(data: memoryview) -> list[Entry]:
    start = data[:_LONGEST_PREAMBLE].tobytes()
    curve = _CURVE.search(start)
    if curve is None:
        raise ValueError("no curve")
    said = _preamble(start[: curve.start()].decode("latin-1"))
    if said.get("points", "Y").upper() != "Y":
        raise ValueError(f"points of the kind {said['points']}; save samples, not an envelope")
    scale, zero, shift = (
        _number(said, *each) for each in (("scale",), ("zero", 0.0), ("shift", 0.0))
    )
    step, first = _number(said, "step"), _number(said, "start", 0.0)
    trigger = _number(said, "trigger", 0.0)
    if not step > 0.0 or scale == 0.0:
        raise ValueError("no time step, or no scale of the values")
    levels = _levels(data[curve.end() :], said)
    if "count" in said and levels.size != int(_number(said, "count")):
        raise ValueError(f"{levels.size} points and the count {said['count']}")
    label = said.get("label", "").split(",")[0].strip() or "value"
    return [
        Entry(
            "time",
            "time",
            said.get("x_unit", "") or "s",
            levels.size,
            functools.partial(_scaled, np.arange(levels.size), step, trigger, first),
        ),
        Entry(
            label,
            label,
            said.get("unit", ""),
            levels.size,
            functools.partial(_scaled, levels, scale, shift, zero),
        ),
    ]


def _preamble(text: str) -> dict[str, str]:
    """Take the preamble apart: value by meaning."""
    said: dict[str, str] = {}
    for name, value in _FIELD.findall(text):
        meaning = _WORDS.get(name.upper())
        if meaning is None:
            continue
        plain = value.strip().strip('"').strip()
        if said.setdefault(meaning, plain) != plain:
            raise ValueError("several curves; save one channel")
    return said


def _number(said: dict[str, str], name: str, default: float | None = None) -> float:
    if name not in said and default is not None:
        return default
    try:
        found = float(said.get(name, ""))
    except ValueError:
        found = np.nan
    if not np.isfinite(found):
        raise ValueError(f"its {name} is {said.get(name, 'missing')!r}")
    return found


def _levels(data: memoryview, said: dict[str, str]) -> NDArray[np.generic]:
    """Give the digitizer's levels, written as text or as a block of bytes."""
    if said.get("encoding", "BIN").upper().startswith("ASC"):
        return np.array([float(cell) for cell in data.tobytes().split(b",")])
    mark = data[:2].tobytes()
    if mark[:1] != b"#" or not mark[1:].isdigit():
        raise ValueError("no block of bytes")
    digits = int(mark[1:])
    length = data[2 : 2 + digits].tobytes()
    if not length.isdigit():
        raise ValueError("a block of bytes without a length")
    block = data[2 + digits :][: int(length)]
    width = int(_number(said, "width"))
    if block.nbytes < int(length) or width not in {1, 2, 4} or block.nbytes % width:
        raise ValueError("its samples lie beyond its end")
    format_ = said.get("format", "RI").upper()
    kind = {"RI": "i", "RP": "u", "FP": "f"}.get(format_)
    if kind is None or (kind == "f" and width != 4):
        raise ValueError(f"numbers of the kind {format_}")
    order = "<" if said.get("order", "MSB").upper().startswith("L") else ">"
    return np.frombuffer(block, dtype=f"{order}{kind}{width}")


def _scaled(
    levels: NDArray[np.generic], scale: float, shift: float, zero: float
) -> NDArray[np.float64]:
    return zero + scale * (levels.astype(np.float64) - shift)
