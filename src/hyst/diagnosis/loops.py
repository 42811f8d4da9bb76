"""Loops of a record: a rising and a falling branch over one range of the input, in few cells."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.memory_branches import remembering_branches
from hyst.signals import Record

Array = NDArray[np.float64]

CELLS = 24
# Near its ends a branch still shows how the drive turned round.
_INNER = np.linspace(0.04, 0.96, CELLS + 1)
INNER_SHARE = float(_INNER[-1] - _INNER[0])
_MOST_LOOPS = 400
_FEWEST_SAMPLES = 12  # of a branch
_SAME_RANGE = 0.03
_SHORTEST = 0.02  # of the range of the drive
_WIDEST_STEP = 0.5  # between two samples, of the range of a loop


@dataclass(frozen=True, eq=False)
class Loop:
    """Two successive branches over the range they share.

    Parameters
    ----------
    start, stop
        Samples of the record.
    low, high
        Ends of the range, input units.
    rate
        Mean of ``|du/dt|``, input units per second.
    up, down
        Mean output in cells of the input, shape (CELLS,), from low to high.
    up_rate, down_rate
        ``|du/dt|`` there.
    samples
        Of a cell, on the mean.
    closed
        Whether it ends where it began.
    memory
        Turning levels that are remembered outside its range; None of a loop that starts where the
        record does, for what came before is not known.
    """

    start: int
    stop: int
    low: float
    high: float
    rate: float
    up: Array
    down: Array
    up_rate: Array
    down_rate: Array
    samples: float
    closed: bool
    memory: tuple[float, ...] | None

    @property
    def middle(self) -> Array:
        """Mean of both branches."""
        return 0.5 * (self.up + self.down)

    @property
    def opening(self) -> Array:
        """Falling branch less rising branch: positive where the output lags a positive gain."""
        return self.down - self.up

    @property
    def height(self) -> float:
        """Range of the output."""
        return max(float(np.ptp(self.up)), float(np.ptp(self.down)))

    @property
    def gain(self) -> float:
        """Slope of the line through the middle, output per input units."""
        t = np.linspace(-0.5, 0.5, CELLS)
        step = (self.high - self.low) * INNER_SHARE * (CELLS - 1) / CELLS
        return float(t @ self.middle) / float(t @ t) / step

    def like(self, other: Loop) -> bool:
        """Whether both have the same range."""
        near = self._near(other)
        return abs(self.low - other.low) <= near and abs(self.high - other.high) <= near

    def comparable(self, other: Loop) -> bool:
        """Whether an actuator without rates must run both alike: range and memory are the same."""
        if not (self.closed and other.closed and self.like(other)):
            return False
        if self.memory is None or other.memory is None:
            return self.memory is other.memory
        return len(self.memory) == len(other.memory) and all(
            abs(one - two) <= self._near(other)
            for one, two in zip(self.memory, other.memory, strict=True)
        )

    def mismatch(self, other: Loop) -> float:
        """Share of the height by which loops may differ for their ranges differ a little."""
        apart = abs(self.low - other.low) + abs(self.high - other.high)
        return apart / min(self.high - self.low, other.high - other.low)

    def _near(self, other: Loop) -> float:
        return _SAME_RANGE * max(self.high - self.low, other.high - other.low)


def loops_of(record: Record, drift: float = 0.0) -> tuple[Loop, ...]:
    """Cut a record into loops.

    Parameters
    ----------
    record
        The record.
    drift
        Of the output, output units per second; it is taken out.
    """
    branches = remembering_branches(record.u)
    span = float(np.ptp(record.u))
    pairs = list(pairwise(branches))
    found = []
    for (a, _, levels), (b, stop, _) in pairs[:: max(len(pairs) // _MOST_LOOPS, 1)]:
        found.append(_loop(record, (a, b, stop - 1), levels, drift))
    if len(branches) == 1:
        # One loop from rest is all there is.
        found.append(_loop(record, (0, branches[0][0], branches[0][1] - 1), None, drift))
    return tuple(
        each for each in found if each is not None and each.high - each.low >= _SHORTEST * span
    )


def mean_loop(loops: tuple[Loop, ...]) -> tuple[Array, Array]:
    """Give the mean rising and falling branch of loops of one range, without their offset."""
    up = np.mean([each.up - each.middle.mean() for each in loops], axis=0)
    down = np.mean([each.down - each.middle.mean() for each in loops], axis=0)
    return up, down


def _loop(
    record: Record, ends: tuple[int, int, int], levels: tuple[float, ...] | None, drift: float
) -> Loop | None:
    """Make a loop of the branches a to b and b to c; None if they share too little."""
    a, b, c = ends
    if min(b - a, c - b) < _FEWEST_SAMPLES:
        return None
    u = record.u
    low = max(min(u[a], u[b]), min(u[b], u[c]))
    high = min(max(u[a], u[b]), max(u[b], u[c]))
    shorter = min(abs(u[b] - u[a]), abs(u[c] - u[b]))
    longer = max(abs(u[b] - u[a]), abs(u[c] - u[b]))
    if not high > low or shorter < 0.5 * longer:
        return None
    edges = low + (high - low) * _INNER
    first = _cells(record, a, b, edges, drift)
    second = _cells(record, b, c, edges, drift)
    if first is None or second is None:
        return None
    rising, falling = (first, second) if u[b] > u[a] else (second, first)
    rate = (abs(u[b] - u[a]) + abs(u[c] - u[b])) / ((c - a) * record.dt)
    near = _SAME_RANGE * longer
    outside = None
    if levels is not None:
        outside = tuple(each for each in levels if not low - near <= each <= high + near)
    return Loop(
        start=a,
        stop=c + 1,
        low=float(low),
        high=float(high),
        rate=float(rate),
        up=rising[0],
        down=falling[0],
        up_rate=rising[1],
        down_rate=falling[1],
        samples=0.5 * (c - a) / CELLS,
        closed=bool(abs(u[c] - u[a]) <= near),
        memory=outside,
    )


def _cells(
    record: Record, start: int, stop: int, edges: Array, drift: float
) -> tuple[Array, Array] | None:
    """Mean output and rate of the input in cells of the input along one branch."""
    u, y = record.u[start : stop + 1], record.y[start : stop + 1]
    t = np.arange(start, stop + 1) * record.dt
    if drift != 0.0:
        y = y - drift * t
    if u[-1] < u[0]:
        u, y, t = u[::-1], y[::-1], t[::-1]
    # Where noise steps back, the drive stands still.
    u = np.maximum.accumulate(u)
    if not u[-1] > u[0]:
        return None
    # Over time and not over input: all samples of a cell count alike.
    duration = np.concatenate([[0.0], np.cumsum(np.full(u.size - 1, record.dt))])
    whole = np.concatenate([[0.0], np.cumsum(0.5 * (y[1:] + y[:-1]) * record.dt)])
    ahead = np.append(True, np.diff(u) > 0.0)
    if np.diff(u[ahead]).max() > _WIDEST_STEP * (edges[-1] - edges[0]):
        return None  # a drive that jumps shows nothing of what lies between
    at = np.interp(edges, u[ahead], duration[ahead])
    area = np.interp(at, duration, whole)
    spent = np.diff(at)
    if not np.all(spent > 0.0):
        return None
    return np.diff(area) / spent, np.diff(edges) / spent
