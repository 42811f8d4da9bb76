"""Read the channels of a TDMS file, as LabVIEW and the DAQ software of NI write them."""

from __future__ import annotations

import contextlib
import functools
import logging
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from hyst.errors import HystError, InputError, MissingExtraError
from hyst.io.entries import Entry, Wanted, table_of_entries, unit_of_label
from hyst.io.table import Table

SUFFIXES = (".tdms",)
# Bytes before a segment, and the bit of its contents that says in which order they stand.
_LEAD_IN, _BIG_ENDIAN = 28, 0x40
_UNITS = ("unit_string", "NI_UnitDescription")


def read_tdms(path: Path, wanted: Wanted) -> Table:
    """Read the numeric channels of a TDMS file.

    A waveform has no channel of time but an increment; ``group/time`` is made from that, or
    ``group/channel/time`` where the channels of a group differ. Stamps become seconds since the
    first.

    Parameters
    ----------
    path
        The file.
    wanted
        Which columns to read, and how many numbers at most.

    Returns
    -------
    Table
        Columns with the header ``group/channel``, called by the channel, with its unit.

    Raises
    ------
    InputError
        If the file is damaged or no TDMS file, holds no column, or more than is allowed.
    MissingExtraError
        If npTDMS is not installed.
    """
    try:
        from nptdms import TdmsFile
    except ImportError as error:
        raise MissingExtraError(
            f'{path}: TDMS files need npTDMS; pip install "hyst[files]"'
        ) from error
    try:
        # Opened here, because the library leaves a file open that turns out to be damaged.
        with path.open("rb") as stream:
            _refuse_unless_whole(stream, path)
        with path.open("rb") as stream, _quietly(), TdmsFile.open(stream) as file:
            entries: list[Entry] = []
            left_out: dict[str, str] = {}
            for group in file.groups():
                entries += _group(group.name, list(group.channels()), left_out)
            return table_of_entries(str(path), entries, wanted, left_out)
    except HystError:
        raise
    # A damaged file fails anywhere in the library, with any exception.
    except Exception as error:
        raise InputError(
            f"{path} is damaged or no TDMS file ({type(error).__name__}); save it again"
        ) from error


def _refuse_unless_whole(stream: BinaryIO, path: Path) -> None:
    """Go from segment to segment: the library would read a file cut short as a shorter one."""
    size = path.stat().st_size
    place = 0
    while place < size:
        stream.seek(place)
        start = stream.read(_LEAD_IN)
        if not b"TDSm".startswith(start[:4]):
            return  # for the library to refuse
        if len(start) == _LEAD_IN:
            order = ">" if start[4] & _BIG_ENDIAN else "<"
            place += _LEAD_IN + struct.unpack_from(order + "Q", start, 12)[0]
        if len(start) < _LEAD_IN or place > size:
            raise InputError(
                f"{path} is damaged or no whole TDMS file (it breaks off in its last segment, as "
                "after a power cut); open it in LabVIEW or DIAdem and save it again"
            )


@contextlib.contextmanager
def _quietly() -> Iterator[None]:
    """Keep the library from printing of a damaged file what the refusal says."""
    from nptdms.log import log_manager

    level = log_manager.console_handler.level
    log_manager.console_handler.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        log_manager.console_handler.setLevel(level)


def _group(group: str, channels: list[Any], left_out: dict[str, str]) -> list[Entry]:
    entries: list[Entry] = []
    clocks: dict[str, tuple[float, float, int, str]] = {}
    for channel in channels:
        header, kind = f"{group}/{channel.name}", np.dtype(channel.dtype)
        if kind.kind not in "biufM":
            left_out[header] = "holds no real numbers"
            continue
        if len(channel) < 2:
            left_out[header] = "is empty" if not len(channel) else "is a single number"
            continue
        name, unit = unit_of_label(channel.name)
        said = (channel.properties.get(each) for each in _UNITS)
        unit = next((str(each) for each in said if each), "s" if kind.kind == "M" else unit)
        read = functools.partial(_values, channel)
        entries.append(Entry(header, name, unit, len(channel), read))
        clock = _clock(channel)
        if clock is not None:
            clocks[channel.name] = clock
    return _times(group, clocks, {entry.header for entry in entries}) + entries


def _values(channel: Any) -> NDArray[Any]:
    values: NDArray[Any] = np.asarray(channel[:])
    if values.dtype.kind == "M":
        # Subtracting whole ticks first: seconds since 1970 leave a double too few digits.
        ticks = values.astype("datetime64[ns]").astype(np.int64)
        values = (ticks - ticks.min()) / 1e9
    return values


def _clock(channel: Any) -> tuple[float, float, int, str] | None:
    """Give start, increment, samples and unit of a waveform."""
    step = channel.properties.get("wf_increment")
    if isinstance(step, bool) or not isinstance(step, int | float) or not step > 0.0:
        return None
    start = channel.properties.get("wf_start_offset", 0.0)
    unit = str(channel.properties.get("wf_xunit_string") or "s")
    return float(start), float(step), len(channel), unit


def _times(
    group: str, clocks: dict[str, tuple[float, float, int, str]], taken: set[str]
) -> list[Entry]:
    """Make the time axes that waveforms imply, one for the group if they share it."""
    shared = len(set(clocks.values())) == 1
    made = {f"{group}/time": clock for clock in clocks.values()} if shared else {}
    if not shared:
        made = {f"{group}/{name}/time": clock for name, clock in clocks.items()}
    entries = []
    for header, (start, step, count, unit) in made.items():
        if header not in taken:
            read = functools.partial(_even, start, step, count)
            entries.append(Entry(header, header.partition("/")[2], unit, count, read))
    return entries


def _even(start: float, step: float, count: int) -> NDArray[np.float64]:
    return start + step * np.arange(count, dtype=np.float64)
