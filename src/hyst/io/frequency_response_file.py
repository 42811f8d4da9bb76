"""Files of frequency responses: frequency with magnitude and phase, or real and imaginary parts."""

from __future__ import annotations

import os
import re

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.io.formats import read_table
from hyst.io.table import Table
from hyst.signals import MeasuredResponse

Array = NDArray[np.float64]

_NAMES = {
    "frequency": ("frequency", "freq", "f", "omega", "w"),
    "magnitude": ("magnitude", "mag", "gain", "amplitude", "abs", "db"),
    "phase": ("phase", "angle", "arg"),
    "real": ("real", "re"),
    "imaginary": ("imaginary", "imag", "im"),
}
_ANGULAR = ("omega", "w")

_FACTORS = {
    "frequency": {"hz": 1.0, "khz": 1e3, "rad/s": 0.5 / np.pi},
    "phase": {"deg": np.pi / 180.0, "degrees": np.pi / 180.0, "°": np.pi / 180.0, "rad": 1.0},
}


def read_frequency_response(path: str | os.PathLike[str]) -> MeasuredResponse:
    r"""Read a measured frequency response from a file of columns.

    Parameters
    ----------
    path
        Any file that ``read_table`` reads, with a column ``frequency`` and either ``magnitude`` and
        ``phase`` or ``real`` and ``imaginary``, by these names or as they are shortened (``freq``,
        ``mag``, ``re``, ``im``); of several, as ``gain`` and ``gain low``, the one without more
        words, so that a ``frequency_response.csv`` of hyst is read, too. Units stand in brackets:
        frequency in ``Hz``, the default, ``kHz`` or ``rad/s``; magnitude in ``dB`` or as it is;
        phase in ``deg``, the default, or ``rad``.

    Returns
    -------
    MeasuredResponse

    Raises
    ------
    InputError
        If the file cannot be read, a column is missing or there twice, its unit is none of these,
        or a value is not finite.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "response.csv"
    >>> _ = path.write_text("frequency [Hz],magnitude [dB],phase [deg]\n10,0,0\n100,20,-90\n")
    >>> found = read_frequency_response(path)
    >>> found.frequency.tolist(), np.abs(found.response).round(9).tolist()
    ([10.0, 100.0], [1.0, 10.0])
    """
    table = read_table(path)
    place = {name: found for name in _NAMES if (found := _place(table, name)) is not None}
    if "frequency" not in place:
        raise InputError(_missing(table, "frequency"))
    frequency = _in_units(table, place["frequency"], "frequency")
    if "real" in place and "imaginary" in place:
        real, imaginary = (table.columns[place[each]] for each in ("real", "imaginary"))
        return _made(table, frequency, real + 1j * imaginary)
    if "magnitude" not in place or "phase" not in place:
        raise InputError(_missing(table, "magnitude and phase, or real and imaginary"))
    size = table.columns[place["magnitude"]]
    if "db" in (_unit(table, place["magnitude"]), _word(table.names[place["magnitude"]])):
        size = 10.0 ** (size / 20.0)
    angle = _in_units(table, place["phase"], "phase")
    return _made(table, frequency, size * np.exp(1j * angle))


def _word(name: str) -> str:
    """Give the first word of a name, in small letters."""
    return next(iter(re.findall(r"[^\W\d_]+", name.lower())), "")


def _unit(table: Table, place: int) -> str:
    return table.units[place].strip().lower()


def _place(table: Table, name: str) -> int | None:
    """Give the column of a quantity; None if there is none."""
    found = [i for i, each in enumerate(table.names) if _word(each) in _NAMES[name]]
    # Beside a gain there may be the ends of its band, "gain low" and "gain high".
    bare = [i for i in found if table.names[i].strip().lower() in _NAMES[name]]
    found = bare if len(bare) == 1 else found
    if len(found) > 1:
        raise InputError(
            f"{table.source} has {len(found)} columns of {name}: "
            f"{', '.join(table.names[i] for i in found)}; leave one"
        )
    return found[0] if found else None


def _in_units(table: Table, place: int, name: str) -> Array:
    """Give frequency in Hz or phase in radians."""
    factors, unit = _FACTORS[name], _unit(table, place)
    if not unit:
        angular = name == "frequency" and _word(table.names[place]) in _ANGULAR
        unit = "rad/s" if angular else next(iter(factors))
    if unit not in factors:
        raise InputError(
            f"{table.source}: {name} is in {table.units[place]!r}; give it in one of "
            f"{', '.join(factors)}"
        )
    return np.asarray(factors[unit] * table.columns[place])


def _missing(table: Table, name: str) -> str:
    return (
        f"{table.source} has no column of {name}, only {', '.join(table.names)}; name the columns "
        "frequency [Hz], and magnitude and phase [deg], or real and imaginary"
    )


def _made(table: Table, frequency: Array, response: NDArray[np.complex128]) -> MeasuredResponse:
    try:
        return MeasuredResponse(frequency, response)
    except InputError as error:
        raise InputError(f"{table.source}: {error}") from None
