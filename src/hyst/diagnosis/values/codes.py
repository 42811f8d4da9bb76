"""Values that stand for something else than a measurement: codes of instruments and loggers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

# Codes stand further outside than this many times the range of everything else.
_FAR = 10.0
# And further still where they are more than a few: pulses of a drive are not rare.
_VERY_FAR = 1000.0
_RARE = 0.02
_LARGEST_SHARE = 0.2
# Double precision itself holds no signal that reaches so little beside what it holds.
_BEYOND_PRECISION = 1e25
_LARGEST_SHARE_THERE = 0.9
_MOST_CODES = 3
_FEWEST_SAMPLES = 8

_MEANINGS = (
    (9.91e37, "instruments write it for 'not a number'"),
    (9.9e37, "instruments write it for an overload"),
    (-9.9e37, "instruments write it for an overload"),
    (9.969209968386869e36, "netCDF files have it where nothing was measured"),
    (1e20, "masked arrays have it where nothing was measured"),
    (3.4028234663852886e38, "it is the largest number of single precision"),
    (-3.4028234663852886e38, "it is the largest number of single precision"),
    (1e30, "programs write it where nothing was measured"),
    (-1e30, "programs write it where nothing was measured"),
    (32767.0, "it is the end of 16 bits"),
    (-32768.0, "it is the end of 16 bits"),
    (65535.0, "it is the end of 16 bits"),
    (2147483647.0, "it is the end of 32 bits"),
    (-2147483648.0, "it is the end of 32 bits"),
    (4294967295.0, "it is the end of 32 bits"),
)
_NINES = (999.0, 9999.0, 99999.0, 999999.0)
# Single precision keeps 7 digits, and so do some files.
_SAME = 1e-6

_LONG, _SOME, _CLOSE = 20_000, 2_000, 0.25


@dataclass(frozen=True, eq=False)
class Code:
    """One value far outside all others.

    Parameters
    ----------
    value
        The number as it stands in the signal.
    samples
        Shape (m,), where it stands, ascending.
    times_the_range
        Its distance from everything else, in ranges of everything else.
    """

    value: float
    samples: NDArray[np.intp]
    times_the_range: float

    @property
    def meaning(self) -> str:
        """What programs are known to write this number for; empty where it is unknown."""
        for known, meaning in _MEANINGS:
            if abs(self.value - known) <= _SAME * abs(known):
                return meaning
        return "loggers write it for a missing value" if abs(self.value) in _NINES else ""


def codes_in(signal: NDArray[np.float64]) -> tuple[Code, ...]:
    """Find values so far outside all others that they are no measurements.

        gap > 10 (reach of all others),   at most 2 % of the samples and at most 3 values

    Up to 20 % of the samples may be codes if they stand a thousand times the reach outside, and up
    to 90 % if they stand 1e25 times outside, where no double tells the others apart. What decides
    is the distance alone, in whatever unit, and never which number it is.

    Parameters
    ----------
    signal
        Shape (N,), finite.

    Returns
    -------
    tuple of Code
        Ascending by value; empty for fewer than 8 samples and for a signal that hardly moves.
    """
    if signal.size < _FEWEST_SAMPLES or _has_no_gap(signal):
        return ()
    # Quarters cannot overflow in a difference.
    quarters = signal / 4.0
    ordered = np.sort(quarters)
    highest = _end_of_the_others(ordered)
    lowest = -_end_of_the_others(-ordered[::-1])
    far = (quarters > highest) | (quarters < lowest)
    values = np.unique(signal[far])
    if not 0 < values.size <= _MOST_CODES:
        return ()
    reach = highest - lowest
    codes = []
    for value in values.tolist():
        times = max(value / 4.0 - highest, lowest - value / 4.0) / reach
        if times >= _FAR:
            codes.append(Code(value, np.flatnonzero(signal == value), times))
    return tuple(codes)


def _has_no_gap(signal: NDArray[np.float64]) -> bool:
    """Tell of most long signals without sorting them that nothing stands far outside.

    Some samples that lie close together span a part of the range; a value no further away than that
    is not ten ranges away.
    """
    if signal.size < _LONG:
        return False
    some = np.sort(signal[:: signal.size // _SOME]) / 4.0
    span = float(some[-1] - some[0])
    if float(np.diff(some).max()) > _CLOSE * span:
        return False
    inside = float(signal.max()) / 4.0 - some[-1] <= span
    return bool(inside and some[0] - float(signal.min()) / 4.0 <= span)


def _end_of_the_others(ordered: NDArray[np.float64]) -> float:
    """Highest value below the first gap that is too wide for a measurement, else the highest."""
    count = ordered.size
    low = ordered[count // 10]
    first = int(np.ceil((1.0 - _LARGEST_SHARE) * count)) - 1
    top = ordered[first:]
    if np.count_nonzero(np.diff(top)) < _MOST_CODES:
        first = max(int(np.ceil((1.0 - _LARGEST_SHARE_THERE) * count)) - 1, 0)
    elif top[0] > low and (top[-1] - top[0]) / _FAR <= top[0] - low:
        return float(top[-1])  # the usual case of a long record: no gap can be wide enough
    upper = ordered[first:]
    reach = upper[:-1] - low
    above = np.arange(upper.size - 1, 0, -1)
    wanted = np.where(above <= _LARGEST_SHARE * count, _VERY_FAR, _BEYOND_PRECISION)
    wanted[above <= max(_RARE * count, 1.0)] = _FAR
    # Divided by what is wanted and not multiplied: it cannot overflow.
    wide = np.flatnonzero((reach > 0.0) & (np.diff(upper) / wanted > reach))
    return float(upper[wide[0]] if wide.size else upper[-1])
