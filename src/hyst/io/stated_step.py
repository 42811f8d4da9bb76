"""The time between rows where a file states it beside its columns."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Sequence

from hyst.io.notation import Writing
from hyst.io.units_of_time import seconds_per_unit

_NUMBER = r"[+-]?(?:\d+(?:[.,]\d+)*\.?|[.,]\d+)(?:[eE][+-]?\d+)?"
# The unit behind the number, or in the next cell.
_UNIT = r"(?P<unit> *[^\s,;\"]*)(?:[\s,;\"]+(?P<next>[^\s,;\"]+))?"
_PER_SAMPLE = re.compile(r"/(?:pts?|points?|samples?|sa)\.?$", re.IGNORECASE)
_FEWER = re.compile(r"(?:decimat|downsampl)\w*[\s\w]*[\s\":=,;]+(?!0*1\b)\d", re.IGNORECASE)
_BETWEEN = r"[\s\"]*(?:[\[(](?P<bracket>[^\])]*)[\])])?[\s\":=,;]+"
_INTERVAL = re.compile(
    r"(?<![\w.])(?:sampl(?:e|ing)[\s_-]?(?:interval|period|time)|x?[\s_-]?increment|x[\s_-]?incr|"
    r"t[\s_-]?inc|delta[\s_-]?[xt]|(?:h|time)[\s_-]?resolution|abtast(?:intervall|zeit)|dt)"
    rf"{_BETWEEN}(?P<number>{_NUMBER}){_UNIT}",
    re.IGNORECASE,
)
_RATE = re.compile(
    r"(?<![\w.])(?:sampl(?:e|ing)[\s_-]?(?:rate|freq(?:uency|\.)?)|abtast(?:rate|frequenz)|fs)"
    rf"{_BETWEEN}(?P<number>{_NUMBER}){_UNIT}",
    re.IGNORECASE,
)
_RATES = {"": 1.0, "hz": 1.0, "hertz": 1.0, "k": 1e3, "khz": 1e3, "mhz": 1e6, "ghz": 1e9}
_PER_SECOND = {"s/s": 1.0, "sa/s": 1.0, "sps": 1.0, "samples/s": 1.0, "1/s": 1.0, "scans/s": 1.0}
_PER_SECOND |= {"samples/sec": 1.0, "samples/second": 1.0, "sa/sec": 1.0, "per second": 1.0}
_RATES |= _PER_SECOND | {f"k{unit}": 1e3 for unit in _PER_SECOND}
_RATES |= {f"m{unit}": 1e6 for unit in _PER_SECOND} | {f"g{unit}": 1e9 for unit in _PER_SECOND}
_UNIT_OF_TIME = re.compile(
    r"(?<![\w.])(?:(?:time|t|x|horizontal|x[\s_-]?axis)[\s_-]?units?(?:[\s_-]?label)?|zeiteinheit)"
    r"[\s\":=,;]+(?P<unit>[^\W\d_]+)",
    re.IGNORECASE,
)
_START_NAMES = {"start", "t0", "x0", "xorigin"}
_STEP_NAMES = {"increment", "tinc", "dx", "xincrement", "xincr"}


def stated_step(lines: Sequence[str], writing: Writing | None = None) -> float | None:
    """Find the step that a preamble or comments state, as an interval or a rate.

    Parameters
    ----------
    lines
        What stands above the columns.
    writing
        How the file is written; it says which sign may stand between thousands.

    Returns
    -------
    float or None
        Seconds; None if there is none, several that differ, one in a unit that is not known, or
        one before samples were left out.

    Examples
    --------
    >>> stated_step(["Model,X1", "Sample Interval,0.005"]), stated_step(["Sample rate: 2 kHz"])
    (0.005, 0.0005)
    >>> stated_step(["fs: 10 V"]), stated_step(["Sample rate: 200 Hz", "Decimation: 5"])
    (None, None)
    """
    if any(_FEWER.search(line) for line in lines):
        return None
    found = [
        _step(match, seconds_per, writing, rate)
        for line in lines
        for pattern, seconds_per, rate in (
            (_INTERVAL, _seconds_per_sample, False),
            (_RATE, _hertz, True),
        )
        for match in pattern.finditer(line)
    ]
    usable = [step for step in found if 0.0 < step < float("inf")]
    if not usable or len(usable) < len(found) or max(usable) > 1.001 * min(usable):
        return None
    return usable[0]


def _step(
    found: re.Match[str],
    value_of: Callable[[str], float | None],
    writing: Writing | None,
    rate: bool,
) -> float:
    """Give the seconds that are stated; 0 where number or unit may mean something else."""
    unit, behind = (found["bracket"] or found["unit"]).strip(), found["next"] or ""
    number = _value(found["number"], writing)
    if not unit and behind and value_of(behind) is not None:
        unit = behind
    factor = value_of(unit)
    if number is None or factor is None or not number * factor > 0.0:
        return 0.0
    return 1.0 / (number * factor) if rate else number * factor


def _seconds_per_sample(unit: str) -> float | None:
    return seconds_per_unit(_PER_SAMPLE.sub("", unit))


def _hertz(unit: str) -> float | None:
    # Millihertz, or megahertz in a careless hand.
    return None if unit == "mHz" else _RATES.get(unit.casefold())


def _value(text: str, writing: Writing | None) -> float | None:
    """Give a number; None where a sign may stand between thousands, as in 1,000."""
    if writing is not None and writing.separator == "," and "," in text:
        return None
    other = "," if writing is None or writing.decimal == "." else "."
    if len(re.findall("[.,]", text)) > 1 or re.fullmatch(rf"[1-9]\d{{0,2}}[{other}]\d{{3}}", text):
        return None
    return _number(text)


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
