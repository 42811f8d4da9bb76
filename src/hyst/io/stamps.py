"""Seconds from stamps as people read them: dates, times of day, or both."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.io.table import Flaw

_DAY = 86400
_NANO = 10**9
_PATTERN = re.compile(
    r"(?:(?P<date>\d{1,4}[-/.](?:\d{1,2}|[A-Za-z]{3})[-/.]\d{1,4})(?:[T\s_]+|$))?"
    r"(?:(?P<hour>\d{1,2}):(?P<minute>\d{2})(?::(?P<second>\d{2}))?(?:[.,:](?P<fraction>\d+))?"
    r"(?:\s*(?P<half>[AaPp])\.?[Mm]\.?)?)?"
    r"\s*(?P<zone>Z|UTC|[+-]\d{2}:?\d{2})?",
    re.ASCII,
)
_MONTHS = dict(
    zip(
        ("jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec"),
        range(1, 13),
        strict=True,
    )
)


@dataclass(frozen=True, eq=False)
class Stamps:
    """Seconds since the first stamp.

    Parameters
    ----------
    seconds
        Shape (N,); NaN where a cell is no stamp.
    flaw
        The first such cell, or that which has two readings.
    notes
        What was found out on the way.
    """

    seconds: NDArray[np.float64]
    flaw: Flaw | None
    notes: tuple[str, ...] = ()


def seconds_of_stamps(cells: Sequence[str]) -> Stamps:
    """Read ISO 8601 stamps, other dates with a time of day, and times of day alone.

    Whole nanoseconds are subtracted before they become doubles. A time of day that passes
    midnight goes on.

    Parameters
    ----------
    cells
        One stamp each.

    Returns
    -------
    Stamps

    Examples
    --------
    >>> seconds_of_stamps(["23:59:59.5", "00:00:00.5"]).seconds.tolist()
    [0.0, 1.0]
    """
    found = [_PATTERN.fullmatch(cell) for cell in cells]
    order = _order_of_date(found)
    if isinstance(order, Flaw):
        return Stamps(np.full(len(cells), math.nan), order)
    short = _are_minutes_and_seconds(found)
    if isinstance(short, Flaw):
        return Stamps(np.full(len(cells), math.nan), replace(short, text=cells[short.row]))
    days: dict[str, int | None] = {}
    ticks = [_nanoseconds(each, order, short, days) for each in found]
    row = next((k for k, tick in enumerate(ticks) if tick is None), None)
    flaw = None if row is None else Flaw(row, cells[row])
    midnights = 0
    if not any(each and each["date"] for each in found):
        ticks, midnights = _past_midnight(ticks)
    first = next((tick for tick in ticks if tick is not None), 0)
    seconds = np.array([math.nan if t is None else (t - first) / _NANO for t in ticks])
    note = f"the time of day passes midnight {midnights} times; it was counted on"
    return Stamps(seconds, flaw, (note,) if midnights else ())


def _nanoseconds(
    match: re.Match[str] | None, order: str, short: bool, days: dict[str, int | None]
) -> int | None:
    if match is None or not (match["date"] or match["hour"]):
        return None
    day: int | None = 0
    if match["date"]:
        if match["date"] not in days:
            days[match["date"]] = _day_number(match["date"], order)
        day = days[match["date"]]
    if day is None:
        return None
    fraction = (match["fraction"] or "0")[:9].ljust(9, "0")
    return (day * _DAY + _second_of_day(match, short)) * _NANO + int(fraction)


def _second_of_day(match: re.Match[str], short: bool) -> int:
    """Give whole seconds; hh:mm:ss, with minutes and seconds alone where there is a fraction."""
    if match["hour"] is None:
        return 0
    first, second, third = int(match["hour"]), int(match["minute"]), int(match["second"] or 0)
    if short and match["second"] is None:
        return first * 60 + second
    if match["half"]:
        first = first % 12 + (12 if match["half"] in "pP" else 0)
    zone = match["zone"] or ""
    offset = 0
    if zone[:1] in "+-" and zone:
        digits = zone[1:].replace(":", "")
        offset = (int(digits[:2]) * 60 + int(digits[2:])) * (60 if zone[0] == "+" else -60)
    return first * 3600 + second * 60 + third - offset


def _are_minutes_and_seconds(found: Sequence[re.Match[str] | None]) -> bool | Flaw:
    """Tell mm:ss from hh:mm: by a fraction, or more than 23 hours; a flaw where nothing tells."""
    two = [(k, each) for k, each in enumerate(found) if each and each["hour"]]
    if not two or any(each["second"] for _, each in two):
        return False
    if any(each["fraction"] or int(each["hour"]) > 23 for _, each in two):
        return True
    if any(each["date"] or each["half"] for _, each in two):
        return False
    why = "which may be hours and minutes or minutes and seconds; write times of day as 12:00:01"
    return Flaw(two[0][0], "", why)


def _day_number(text: str, order: str) -> int | None:
    parts = re.split(r"[-/.]", text)
    numbers = [_MONTHS.get(part.lower(), 0) if part.isalpha() else int(part) for part in parts]
    by_sign = dict(zip(order, numbers, strict=True))
    year = by_sign["y"]
    try:
        day = np.datetime64(
            f"{year + 2000 if year < 100 else year:04d}-{by_sign['m']:02d}-{by_sign['d']:02d}"
        )
    except ValueError:
        return None
    return int(day.astype(np.int64))


def _order_of_date(found: Sequence[re.Match[str] | None]) -> str | Flaw:
    """Tell year, month and day apart; a flaw where the dates differ and nothing says which is."""
    dates = {each["date"]: row for row, each in reversed(list(enumerate(found))) if each}
    dates.pop(None, None)
    if not dates:
        return "ymd"
    parts = [re.split(r"[-/.]", date) for date in dates]
    if any(len(each[0]) > 2 for each in parts):
        return "ymd"
    if any("." in date or any(c.isalpha() for c in date) for date in dates):
        return "dmy"
    if any(int(each[0]) > 12 for each in parts):
        return "dmy"
    if any(int(each[1]) > 12 for each in parts) or len(dates) == 1:
        return "mdy"
    date, row = max(dates.items(), key=lambda each: each[1])
    why = (
        "which may be day/month or month/day, and the dates of the file do not tell; "
        "write dates as 2026-11-28"
    )
    return Flaw(row, date, why)


def _past_midnight(ticks: Sequence[int | None]) -> tuple[list[int | None], int]:
    """Go on after midnight, where a time of day falls by more than half a day; say how often."""
    midnights, before = 0, None
    counted: list[int | None] = []
    for tick in ticks:
        if tick is not None:
            if before is not None and before - tick > _DAY * _NANO // 2:
                midnights += 1
            before = tick
        counted.append(None if tick is None else tick + midnights * _DAY * _NANO)
    return counted, midnights
