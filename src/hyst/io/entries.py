"""From what a binary file holds to a table: sizes are checked first, wanted columns read after."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.io.columns import find_column
from hyst.io.header import split_unit
from hyst.io.table import Flaw, Table, first_flaw

# 0.8 GB of doubles; whoever has more says so.
MOST_SAMPLES = 100_000_000
# An image or a table of curves is no record; each of its columns would have to be named.
_MOST_COLUMNS = 1000
_SHOWN = 3

Selector = tuple[int | slice, ...]


class TooManySamples(InputError):  # noqa: N818  a kind of bad input, named for what it is
    """There are more numbers to read than allowed; ``samples`` is how many."""

    samples: int = 0


@dataclass(frozen=True)
class Wanted:
    """What is to be read of a file.

    Parameters
    ----------
    columns
        The columns, as ``find_column`` takes them; None for all.
    most
        Most numbers to read, all columns together.
    """

    columns: tuple[int | str, ...] | None = None
    most: int = MOST_SAMPLES


@dataclass(frozen=True, eq=False)
class Entry:
    """A column that a file holds and that need not have been read.

    Parameters
    ----------
    header
        Its full name, for instance the path within the file.
    name, unit
        What to call it.
    size
        Number of values.
    read
        Gives the values, of any real type; masked where there is none.
    gap
        What a masked value is called in messages; empty for no value.
    part
        Gives those of some rows, first and one past the last; None where only all can be read.
    """

    header: str
    name: str
    unit: str
    size: int
    read: Callable[[], NDArray[Any]]
    gap: str = ""
    part: Callable[[int, int], NDArray[Any]] | None = None


@dataclass(frozen=True, eq=False)
class Stored:
    """An array of real numbers within a file.

    Parameters
    ----------
    shape
        Its shape.
    read
        Gives the part that an index selects, masked where there is no value.
    gap
        As of ``Entry``.
    """

    shape: tuple[int, ...]
    read: Callable[[Selector], NDArray[Any]]
    gap: str = ""


@dataclass(eq=False)
class Contents:
    """What has been found in a file so far, by path within the file.

    Parameters
    ----------
    arrays
        Arrays of real numbers.
    texts, units
        Texts, and units of those arrays that have one.
    labels
        What to call an array, where it is not its path.
    left_out
        What is no column, and why: a phrase that follows the name.
    """

    arrays: dict[str, Stored] = field(default_factory=dict)
    texts: dict[str, str] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    labels: dict[str, str] = field(default_factory=dict)
    left_out: dict[str, str] = field(default_factory=dict)

    def add(self, path: str, array: NDArray[Any], gap: str = "") -> None:
        """Add an array that is in memory; complex numbers without imaginary part are real.

        Parameters
        ----------
        path
            Its path within the file.
        array
            Of any type; what is no number is left out.
        gap
            As of ``Entry``.
        """
        if array.dtype.kind == "c":
            if array.imag.any():
                self.left_out[path] = "is complex; save its real part, or its magnitude"
                return
            array = array.real
        if array.dtype.kind in "biuf":
            self.arrays[path] = Stored(array.shape, array.__getitem__, gap)
        else:
            self.left_out[path] = "holds no numbers"

    def entries(self, separator: str) -> list[Entry]:
        """List the columns, in the order they were found; scalars and blocks are left out."""
        found: list[Entry] = []
        for path, stored in self.arrays.items():
            selectors, reason = columns_of(stored.shape)
            if reason:
                self.left_out[path] = reason
            name, unit = _name_and_unit(path, separator, self.labels.get(path, ""))
            unit = self.units.get(path, "") or unit
            size = max(stored.shape, default=0)
            for tail, selector in selectors:
                read, part = _reading(stored, selector), _reading_part(stored, selector)
                found.append(Entry(path + tail, name + tail, unit, size, read, stored.gap, part))
        return found


def _reading(stored: Stored, selector: Selector) -> Callable[[], NDArray[Any]]:
    return lambda: stored.read(selector)


def _reading_part(stored: Stored, selector: Selector) -> Callable[[int, int], NDArray[Any]]:
    def read(start: int, stop: int) -> NDArray[Any]:
        rows = slice(start, stop)
        return stored.read(tuple(rows if isinstance(k, slice) else k for k in selector))

    return read


def _name_and_unit(path: str, separator: str, label: str) -> tuple[str, str]:
    """Take the unit out of the last part of a path, or of the label in its place."""
    if label:
        return unit_of_label(label)
    head, mark, leaf = path.rpartition(separator)
    name, unit = split_unit(leaf)
    return head + mark + name, unit


def unit_of_label(label: str) -> tuple[str, str]:
    """Split ``voltage [V]``, but not ``Model Root/voltage``: tools write paths into labels.

    Parameters
    ----------
    label
        What a tool calls a signal.

    Examples
    --------
    >>> unit_of_label("voltage (V)"), unit_of_label("Model Root/In1")
    (('voltage', 'V'), ('Model Root/In1', ''))
    """
    return split_unit(label) if "/" not in label else (label, "")


def columns_of(shape: Sequence[int]) -> tuple[list[tuple[str, Selector]], str]:
    """Tell which columns an array has, or why it has none.

    Axes of length 1 do not count. The longer of two axes holds the samples; of a square matrix
    it is the first.

    Parameters
    ----------
    shape
        Shape of the array.

    Returns
    -------
    list of tuple
        What to append to the name, and the index of the column.
    str
        Why there are none; empty where there are some.

    Examples
    --------
    >>> columns_of((1, 1, 5))
    ([('', (0, 0, slice(None, None, None)))], '')
    >>> [tail for tail, _ in columns_of((2, 600))[0]], columns_of(())[1]
    (['[0]', '[1]'], 'is a single number')
    """
    long = [axis for axis, size in enumerate(shape) if size > 1]
    if 0 in shape:
        return [], "is empty"
    if not long:
        return [], "is a single number"
    if len(long) > 2:
        return [], f"has {len(long)} axes; save its columns as vectors"
    samples = max(long, key=lambda axis: (shape[axis], -axis))
    index: list[int | slice] = [0] * len(shape)
    index[samples] = slice(None)
    if len(long) == 1:
        return [("", tuple(index))], ""
    other = long[0] if long[1] == samples else long[1]
    if shape[other] > _MOST_COLUMNS:
        return [], f"has {shape[other]} columns; save those that are wanted as vectors"
    chosen = []
    for k in range(shape[other]):
        index[other] = k
        chosen.append((f"[{k}]", tuple(index)))
    return chosen, ""


def table_of_entries(
    source: str, entries: Sequence[Entry], wanted: Wanted, left_out: dict[str, str] | None = None
) -> Table:
    """Read the wanted columns into a table; the others are there by name and have no values.

    Parameters
    ----------
    source
        Name of the file.
    entries
        All its columns.
    wanted
        Which of them to read, and how many numbers at most.
    left_out
        What else the file holds, and why it is no column.

    Returns
    -------
    Table
        As many columns as there are entries.

    Raises
    ------
    InputError
        If there is no column, no such column, or more numbers than allowed.
    """
    others = left_out or {}
    if not entries:
        raise InputError(f"{source} holds no array of at least 2 real numbers{_because(others)}")
    empty = np.empty(0)
    empty.flags.writeable = False
    table = Table(
        source=source,
        names=tuple(entry.name for entry in entries),
        units=tuple(entry.unit for entry in entries),
        columns=(empty,) * len(entries),
        headers=tuple(entry.header for entry in entries),
        flaws=(None,) * len(entries),
        left_out=others,
    )
    chosen = set(range(len(entries)))
    if wanted.columns is not None:
        chosen = {find_column(table, column) for column in wanted.columns}
    refuse_too_many(source, sum(entries[k].size for k in chosen), wanted.most)
    read = [
        vector_of_entry(entry.read, entry.gap) if k in chosen else (empty, None)
        for k, entry in enumerate(entries)
    ]
    return replace(
        table,
        columns=tuple(vector for vector, _ in read),
        flaws=tuple(flaw for _, flaw in read),
    )


def refuse_too_many(source: str, count: float, most: int) -> None:
    """Refuse to read more numbers than allowed, before there is memory for them.

    Parameters
    ----------
    source
        Name of the file.
    count, most
        How many there are, and may be.

    Raises
    ------
    TooManySamples
        If there are more.
    """
    if count > most:
        refusal = TooManySamples(
            f"{source} holds {count:.3g} numbers in the columns to read, and at most {most:.3g} "
            "are read; cut the record, or raise max_samples"
        )
        refusal.samples = int(count)
        raise refusal


def _because(left_out: dict[str, str]) -> str:
    reasons = [f"{name!r} {why}" for name, why in left_out.items() if "single" not in why]
    if not reasons:
        return "; save the signals as numeric vectors"
    return f": {'; '.join(reasons[:_SHOWN])}"


def vector_of_entry(
    read: Callable[[], NDArray[Any]], gap: str
) -> tuple[NDArray[np.float64], Flaw | None]:
    """Read a column as doubles that nobody can change, and find its first flaw.

    Parameters
    ----------
    read, gap
        As of ``Entry``.
    """
    # What is scaled beyond the range of a double is infinite, and refused as such.
    with np.errstate(over="ignore", invalid="ignore"):
        values = read()
    masked = np.ma.getmaskarray(values) if np.ma.is_masked(values) else None
    vector = np.array(np.ma.getdata(values), dtype=np.float64, order="C").reshape(-1)
    if masked is not None:
        vector[masked.reshape(-1)] = np.nan
    vector.flags.writeable = False
    flaw = first_flaw(vector)
    if flaw is not None and masked is not None and masked.reshape(-1)[flaw.row]:
        flaw = Flaw(flaw.row, gap)
    return vector, flaw
