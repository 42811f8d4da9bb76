"""Values that are no measurements: codes that instruments write for overload or for nothing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

# SCPI writes 9.9E37 for an overload and 9.91E37 for not a number; nothing measured is as large.
_BEYOND_MEASURE = 9e36
_CODES = frozenset(
    (
        *(10.0**k - 1.0 for k in range(3, 8)),
        *(999.25, 999.9, 9999.9, 99999.9, 8888.0, 7777.0),
        *(32767.0, 32768.0, 65535.0, 2147483647.0, 2147483648.0, 4294967295.0),
        *(1e10, 1e15, 1e20, 1e30, 1e34, 1e35, 1e36),
    )
)
# A known code stands at least so many ranges of all other values away from them, another value
# that stands there several times so many.
_APART, _FAR_APART = 1.0, 10.0
_LARGEST_SHARE, _SMALL_SHARE = 0.2, 0.02
_LONGEST_RUN = 3
_MOST_CODES = 4


@dataclass(frozen=True, eq=False)
class Code:
    """A value that stands for no measurement.

    Parameters
    ----------
    value
        As it stands in the file.
    rows
        Where it stands, ascending.
    """

    value: float
    rows: NDArray[np.intp]


def find_codes(values: NDArray[np.float64]) -> list[Code]:
    """Find values that are no measurements: extremes far from everything else, one and the same.

    Parameters
    ----------
    values
        Shape (N,); what is not finite is passed over.

    Returns
    -------
    list of Code
        Numbers beyond 9e36; known codes at least as far from all other values as those reach;
        other numbers that stand several times at ten times that distance.

    Examples
    --------
    >>> found = find_codes(np.array([0.0, 1.0, -9999.0, 2.0, 1.0, -9999.0]))
    >>> [(each.value, each.rows.tolist()) for each in found]
    [(-9999.0, [2, 5])]
    """
    found: list[Code] = []
    left = np.isfinite(values)
    for value in np.unique(values[left & (np.abs(values) >= _BEYOND_MEASURE)])[:_MOST_CODES]:
        rows = np.flatnonzero(values == value)
        found.append(Code(float(value), rows))
    left &= np.abs(values) < _BEYOND_MEASURE
    while len(found) < _MOST_CODES and left.any():
        value = _extreme_code(values[left])
        if value is None:
            break
        found.append(Code(value, np.flatnonzero(values == value)))
        left &= values != value
    return found


def _extreme_code(values: NDArray[np.float64]) -> float | None:
    """Give the least or greatest value if it is a code."""
    for value in (float(values.min()), float(values.max())):
        others = values[values != value]
        count = values.size - others.size
        if not others.size or count > _LARGEST_SHARE * values.size + 1:
            continue
        low, high = float(others.min()), float(others.max())
        distance = max(low - value, value - high)
        span = high - low
        if span <= 0.0:
            continue
        known = abs(value) in _CODES and distance >= _APART * span
        far = count > 1 and distance >= _FAR_APART * span and count <= _SMALL_SHARE * values.size
        if known or (far and _longest_run(values == value) <= _LONGEST_RUN):
            return value
    return None


def _longest_run(there: NDArray[np.bool_]) -> int:
    """Give the length of the longest stretch: a level that is held is a measurement."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], there.view(np.int8), [0]))))
    return int((edges[1::2] - edges[::2]).max())
