"""The time between rows where a file states it beside its columns."""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence

from hyst.io.notation import Writing
from hyst.io.units_of_time import seconds_per_unit

_NUMBER = r"[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][+-]?\d+)?"
_BETWEEN = r"[\s\"]*(?:[\[(](?P<bracket>[^\])]*)[\])])?[\s\":=,;]+"
_INTERVAL = re.compile(
    r"(?<![\w.])(?:sampl(?:e|ing)[\s_-]?(?:interval|period|time)|x?[\s_-]?increment|x[\s_-]?incr|"
    r"t[\s_-]?inc|delta[\s_-]?[xt]|(?:h|time)[\s_-]?resolution|abtast(?:intervall|zeit)|dt)"
    rf"{_BETWEEN}(?P<number>{_NUMBER})\s*(?P<unit>[^\s,;\"]*)",
    re.IGNORECASE,
)
_RATE = re.compile(
    r"(?<![\w.])(?:sampl(?:e|ing)[\s_-]?(?:rate|freq(?:uency|\.)?)|abtast(?:rate|frequenz)|fs)"
    rf"{_BETWEEN}(?P<number>{_NUMBER})\s*(?P<unit>[^\s,;\"]*)",
    re.IGNORECASE,
)
_RATES = {"": 1.0, "hz": 1.0, "khz": 1e3, "mhz": 1e6, "ghz": 1e9}
_PER_SECOND = {"s/s": 1.0, "sa/s": 1.0, "sps": 1.0, "samples/s": 1.0, "1/s": 1.0}
_RATES |= _PER_SECOND | {f"k{unit}": 1e3 for unit in _PER_SECOND}
_RATES |= {f"m{unit}": 1e6 for unit in _PER_SECOND} | {f"g{unit}": 1e9 for unit in _PER_SECOND}
_UNIT_OF_TIME = re.compile(
    r"(?<![\w.])(?:(?:time|t|x|horizontal|x[\s_-]?axis)[\s_-]?units?(?:[\s_-]?label)?|zeiteinheit)"
    r"[\s\":=,;]+(?P<unit>[^\W\d_]+)",
    re.IGNORECASE,
)
_START_NAMES = {"start", "t0", "x0", "xorigin"}
_STEP_NAMES = {"increment", "tinc", "dx", "xincrement", "xincr"}


def stated_step(lines: Sequence[str]) -> float | None:
    """Find the step that a preamble or comments state, as an interval or a rate.

    Parameters
    ----------
    lines
        What stands above the columns.

    Returns
    -------
    float or None
        Seconds; None if there is none, or several that differ.

    Examples
    --------
    >>> stated_step(["Model,X1", "Sample Interval,0.005"]), stated_step(["Sample rate: 2 kHz"])
    (0.005, 0.0005)
    """
    steps = []
    for line in lines:
        for found in _INTERVAL.finditer(line):
            seconds = seconds_per_unit(found["bracket"] or found["unit"])
            steps.append(_number(found["number"]) * (1.0 if seconds is None else seconds))
        for found in _RATE.finditer(line):
            factor = _RATES.get((found["bracket"] or found["unit"]).strip().casefold(), 1.0)
            rate = _number(found["number"]) * factor
            steps.append(1.0 / rate if rate > 0.0 else 0.0)
    usable = [step for step in steps if 0.0 < step < float("inf")]
    if not usable or max(usable) > 1.001 * min(usable):
        return None
    return usable[0]


def stated_unit_of_time(lines: Sequence[str]) -> str:
    """Find the unit of the stamps that a preamble or comments state; nothing if none or seconds.

    Examples
    --------
    >>> stated_unit_of_time(["Model,X1", "Time Unit,ms"]), stated_unit_of_time(["time: 5 ms"])
    ('ms', '')
    """
    found = (match["unit"] for line in lines for match in _UNIT_OF_TIME.finditer(line))
    return next((unit for unit in found if seconds_per_unit(unit) not in {None, 1.0}), "")


def start_and_step(above: Sequence[str], writing: Writing) -> tuple[int, float, float] | None:
    """Find start and step of the time in cells of two header rows, as some oscilloscopes write.

    Parameters
    ----------
    above
        The lines before the numbers.
    writing
        How the file is written.

    Returns
    -------
    tuple or None
        How many cells stand before them, start and step.

    Examples
    --------
    >>> start_and_step(["X,CH1,Start,Increment,", "Sequence,Volt,0,5e-3"], Writing(",", "."))
    (2, 0.0, 0.005)
    """
    for upper, lower in itertools.pairwise(above[-3:]):
        names = [cell.casefold() for cell in writing.cells(upper)]
        values = writing.cells(lower)
        for column in range(min(len(names), len(values)) - 1):
            if names[column] in _START_NAMES and names[column + 1] in _STEP_NAMES:
                pair = values[column : column + 2]
                if all(map(writing.is_number, pair)):
                    start, step = map(_number, pair)
                    return (column, start, step) if step > 0.0 else None
    return None


def _number(text: str) -> float:
    return float(text.replace(",", "."))
