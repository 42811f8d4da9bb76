"""Records out of tables of other libraries in memory: data frames, and arrays with coordinates.

No library is loaded for it: what looks like a data frame or a Dataset is taken for one.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.io.columns import find_column
from hyst.io.header import split_unit
from hyst.io.record_of_table import Wanted, record_of_table
from hyst.io.table import Flaw, Table, first_flaw
from hyst.signals import Record

Array = NDArray[np.float64]

_NANOSECONDS = 1e-9


def record_of_frame(
    frame: Any,
    input: int | str,
    output: int | str,
    time: int | str | None,
    rate: float | None,
    how: Mapping[str, Any],
) -> Record:
    """Take a record from columns of a data frame.

    Parameters
    ----------
    frame, input, output, time, rate, how
        As of ``Record.from_dataframe``.

    Raises
    ------
    InputError
        See there.
    """
    if not hasattr(frame, "columns") or not hasattr(frame, "__getitem__"):
        raise InputError(
            f"the data frame is of type {type(frame).__name__}; give a table with columns, as of "
            "pandas, or u, y and dt to hyst.Record"
        )
    names = [str(each) for each in frame.columns]
    units = _units(getattr(frame, "attrs", {}))
    read: dict[str, Callable[[], Any]] = {
        f"{name}\0{k}": partial(_column, frame, k) for k, name in enumerate(names)
    }
    index = getattr(frame, "index", None)
    if time is None and rate is None and index is not None:
        if not _tells_time(index):
            raise InputError(
                "the index of the data frame counts rows and is no time; give rate, in Hz, or "
                "time, a column"
            )
        called = getattr(index, "name", None)
        name = "index of the data frame" if called is None else str(called)
        read[f"{name}\0{len(names)}"] = lambda: index
        time = len(names)
    table = _table("the data frame", read, units, (input, output, time))
    return _record(table, Wanted(input, output, time, rate, **_known(how)))


def record_of_arrays(
    data: Any, input: str, output: str, time: str, rate: float | None, how: Mapping[str, Any]
) -> Record:
    """Take a record from variables with coordinates.

    Parameters
    ----------
    data, input, output, time, rate, how
        As of ``Record.from_xarray``.

    Raises
    ------
    InputError
        See there.
    """
    chosen = _channels(data, time)
    for each in (input, output):
        if str(each) not in chosen:
            raise InputError(f"there is no {each!r}; there are {', '.join(chosen) or 'none'}")
        sizes = tuple(str(name) for name in chosen[str(each)].dims)
        if sizes != (time,):
            raise InputError(
                f"{each!r} has the dimensions {', '.join(sizes) or 'none'}; give one along "
                f"{time!r} alone, as data.isel(...) does"
            )
    arrays = [(str(each), chosen[str(each)]) for each in (input, output)]
    if rate is None:
        if time not in data.coords:
            raise InputError(
                f"there is no coordinate {time!r}; give rate, in Hz, or the name of the time"
            )
        arrays.append((time, data.coords[time]))
    read: dict[str, Callable[[], Any]] = {
        f"{name}\0{k}": partial(getattr, each, "values") for k, (name, each) in enumerate(arrays)
    }
    stamps = None if rate is not None else 2
    units = {name: _said(each) for name, each in arrays}
    table = _table("the data", read, units, (0, 1, stamps))
    return _record(table, Wanted(0, 1, stamps, rate, **_known(how)))


def _channels(data: Any, time: str) -> Mapping[str, Any]:
    """Give what a Dataset or a DataArray holds, by name."""
    if hasattr(data, "data_vars"):
        return {str(name): each for name, each in data.data_vars.items()}
    if not (hasattr(data, "dims") and hasattr(data, "coords")):
        raise InputError(
            f"the data are of type {type(data).__name__}; give a Dataset or a DataArray of xarray"
        )
    others = [each for each in data.dims if each != time]
    if time not in data.dims or len(others) != 1 or others[0] not in data.coords:
        raise InputError(
            f"the array has the dimensions {', '.join(map(str, data.dims))}; give {time!r} and one "
            "more with the names of the channels as its labels, or a Dataset"
        )
    labels = data.coords[others[0]].values
    return {str(each): data.sel({others[0]: each}) for each in labels}


def _known(how: Mapping[str, Any]) -> dict[str, Any]:
    options = ("time_unit", "repair", "dead_band", "longest_gap", "one_way")
    for name in how:
        if name not in options:
            raise InputError(f"there is no option {name!r}; there are {', '.join(options)}")
    return dict(how)


def _record(table: Table, wanted: Wanted) -> Record:
    return record_of_table(table, wanted, lambda whole, column: whole.columns[column])


def _table(
    source: str,
    read: Mapping[str, Callable[[], Any]],
    units: Mapping[str, str],
    wanted: Iterable[int | str | None],
) -> Table:
    """Make a table, of whose columns only those that are wanted are read."""
    headers = tuple(each.rpartition("\0")[0] for each in read)
    names, found = (tuple(each) for each in zip(*map(split_unit, headers), strict=True))
    told = tuple(unit or units.get(each, "") for each, unit in zip(headers, found, strict=True))
    empty, count = np.empty(0), len(headers)
    whole = Table(source, names, told, (empty,) * count, headers, (None,) * count)
    columns, flaws, said = list(whole.columns), list(whole.flaws), list(whole.units)
    gets = list(read.values())
    for k in {find_column(whole, each) for each in wanted if each is not None}:
        columns[k], flaws[k], clock = _numbers(gets[k]())
        said[k] = "s" if clock else said[k]
    return replace(whole, units=tuple(said), columns=tuple(columns), flaws=tuple(flaws))


def _numbers(values: Any) -> tuple[Array, Flaw | None, bool]:
    """Give values as doubles, what is first no number in them, and whether they were dates."""
    given = _plain(values)
    if given.dtype.kind in "mM":
        return *_seconds(given), True
    if given.dtype.kind in "fiub":
        vector = np.array(given, dtype=np.float64)
        vector.setflags(write=False)
        return vector, first_flaw(vector), False
    # Text, or numbers among missing values, as pandas has them.
    vector, flaw = np.full(given.shape, np.nan), None
    for row, each in enumerate(given.tolist()):
        with contextlib.suppress(TypeError, ValueError):
            vector[row] = np.nan if each is None or isinstance(each, str) else float(each)
        if flaw is None and not np.isfinite(vector[row]):
            flaw = Flaw(row, each if isinstance(each, str) else "")
    vector.setflags(write=False)
    return vector, flaw, False


def _plain(values: Any) -> Any:
    """Give values as an array of numpy; dates of a time zone as those of UTC."""
    if not hasattr(values, "to_numpy"):
        return np.asarray(values)
    zoned = str(getattr(values, "dtype", "")).startswith("datetime64[")
    return np.asarray(values.to_numpy(dtype="datetime64[ns]") if zoned else values.to_numpy())


def _seconds(stamps: Any) -> tuple[Array, Flaw | None]:
    """Give dates or durations as seconds since the first, exact to the nanosecond."""
    missing = np.isnat(stamps)
    counts = stamps.astype(f"{stamps.dtype.str[1]}8[ns]").view(np.int64)
    known = counts[~missing]
    seconds = (counts - (known[0] if known.size else 0)) * _NANOSECONDS
    seconds[missing] = np.nan
    seconds.setflags(write=False)
    return seconds, first_flaw(seconds)


def _column(frame: Any, place: int) -> Any:
    """Give a column by its place, for names may come twice."""
    if hasattr(frame, "iloc"):
        return frame.iloc[:, place]
    return frame[list(frame.columns)[place]]


def _tells_time(index: Any) -> bool:
    return _plain(index).dtype.kind in "mMf"


def _units(attributes: Mapping[Any, Any]) -> dict[str, str]:
    said = attributes.get("units", attributes.get("unit", {}))
    given = said if isinstance(said, Mapping) else {}
    return {str(name): str(unit) for name, unit in given.items() if unit}


def _said(array: Any) -> str:
    attributes = getattr(array, "attrs", {})
    return str(attributes.get("units", attributes.get("unit", "")))
