"""Sines in what a fit leaves that are none of the drive's."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.judgement.drive_cycles import cycles_of
from hyst.identification.judgement.general_loops import loops_at
from hyst.identification.judgement.remainder import Part, Remainder

Array = NDArray[np.float64]

MOST_SAMPLES = 16_384
FEWEST_SAMPLES = 64
MOST_LINES = 3

ABOVE_THE_FLOOR = 40.0
"""Power of a line over the mean of its neighbourhood: of white noise, less than 20."""

SHARE_OF_THE_REST = 0.05
DOMINATES = 0.5
"""Share of the rest that a line must hold where multiples of the drive are not told apart."""

NEIGHBOURS = 40
FEWEST_BINS = 4.0
"""Between multiples of the drive's frequency, to tell them apart."""

LOWEST_ORDER = 6.0
"""Of a line, in frequencies of the drive: lower ones are a loop's shape, or that as it changes."""

OF_A_SHAPE = 0.2
"""Power at neighbouring multiples of the drive, over that of the line, of a misfit and no line."""

OF_THE_DRIVE = 1e-4
"""Power of the drive at the line, over its largest: with more, a line may be the drive's."""


def lines_of(remainder: Remainder) -> tuple[float, ...]:
    """Give the frequencies of sines that are not the drive's, in cycles a second."""
    return remainder.once("lines", lambda: _lines(remainder))


def longest_part(remainder: Remainder) -> Part:
    """Give the part with most samples."""
    return max(remainder.parts, key=lambda each: each.u.size)


def _lines(remainder: Remainder) -> tuple[float, ...]:
    part = longest_part(remainder)
    n = min(part.u.size, MOST_SAMPLES)
    if n < FEWEST_SAMPLES:
        return ()
    k = np.arange(n, dtype=np.float64)
    trend = np.column_stack([np.ones(n), k / n, (k / n) ** 2])
    columns = np.column_stack([trend, loops_at(remainder, part, np.arange(n))])
    error = part.error[:n]
    found = list[float]()
    while len(found) < MOST_LINES:
        rest = error - columns @ np.linalg.lstsq(columns, error, rcond=1e-9)[0]
        place = _strongest(rest, part, n)
        if place == 0:
            break
        omega = _refined(rest, 2.0 * np.pi * place / n)
        columns = np.column_stack([columns, np.cos(omega * k), np.sin(omega * k)])
        found.append(float(omega / (2.0 * np.pi * part.dt)))
    return tuple(found)


def _strongest(rest: Array, part: Part, n: int) -> int:
    """Give the bin of the strongest line; 0 if it is none, or one of the drive's."""
    window = np.hanning(n)
    power = np.abs(np.fft.rfft(rest * window)) ** 2
    power[:3] = 0.0
    at = int(power.argmax())
    total = float(power.sum())
    near = np.r_[power[max(at - NEIGHBOURS, 3) : max(at - 3, 3)], power[at + 4 : at + NEIGHBOURS]]
    line = float(power[max(at - 2, 0) : at + 3].sum())
    if near.size < 8 or line < SHARE_OF_THE_REST * total:
        return 0
    if power[at] < ABOVE_THE_FLOOR * float(near.mean()):
        return 0
    return 0 if _is_the_drives(at, power, part, n) else at


def _is_the_drives(at: int, power: Array, part: Part, n: int) -> bool:
    """Tell whether a line is part of a loop's shape, or of what the drive does."""
    window = np.hanning(n)
    u = part.u[:n] - part.u[:n].mean()
    drive = np.abs(np.fft.rfft(u * window)) ** 2
    if drive[max(at - 1, 0) : at + 2].max() > OF_THE_DRIVE * drive.max():
        return True
    first = cycles_of(part) * n / part.u.size
    order = at / max(first, 1.0)
    if order < LOWEST_ORDER:
        return True
    if first < FEWEST_BINS:
        return float(power[max(at - 2, 0) : at + 3].sum()) < DOMINATES * float(power.sum())
    if abs(order - round(order)) * first > 1.5:
        return False
    around = [round((round(order) + step) * first) for step in (-2, -1, 1, 2)]
    apart = [each for each in around if 2 < each < power.size and abs(each - at) > 2]
    beside = max((float(power[each - 1 : each + 2].max()) for each in apart), default=0.0)
    return beside > OF_A_SHAPE * float(power[at])


def _refined(rest: Array, omega: float) -> float:
    """Move an angular frequency, radians a sample, to where a sine explains most."""
    k = np.arange(rest.size) - (rest.size - 1) / 2.0
    largest = np.pi / rest.size
    for _ in range(4):
        cosine, sine = np.cos(omega * k), np.sin(omega * k)
        a, b = np.linalg.lstsq(np.column_stack([cosine, sine]), rest, rcond=None)[0]
        turned = k * (b * cosine - a * sine)
        columns = np.column_stack([cosine, sine, turned])
        step = np.linalg.lstsq(columns, rest, rcond=None)[0][2]
        omega += float(np.clip(step, -largest, largest))
    return omega
