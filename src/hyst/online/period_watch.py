"""How long a motion takes from one turn to the next of its kind."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, final

from hyst.errors import InputError

# It turns when it goes back by this share of its way between turns; less is a ripple or an inner
# loop, whose time is not that of the motion.
_BACK = 0.5
# After so many periods without a turn the motion has become a smaller one.
_PATIENCE = 4
_HALVES = 4
_PERIODS = 4


@final
@dataclass
class PeriodWatch:
    """Counts samples between turns of a signal, as it comes.

    A period is the time from one turn to the second next. Of motions that mix several the longest
    of the last four counts.

    Parameters
    ----------
    samples
        Since the last turn but one, and since the last.
    since
        Samples since the last turn was passed.
    direction
        1 while it rises, -1 while it falls, 0 before it has moved.
    low, high
        The least and the largest value since the last turn, or since the start.
    ways
        Of the last turns: how far it went.
    halves
        How many samples it took.
    periods
        The last periods, samples.

    Examples
    --------
    >>> watch = PeriodWatch()
    >>> for k in range(400):
    ...     watch.see(math.sin(2.0 * math.pi * k / 100.0))
    >>> watch.longest
    100
    """

    samples: int = 0
    since: int = 0
    direction: int = 0
    low: float = math.nan
    high: float = math.nan
    ways: list[float] = field(default_factory=list)
    halves: list[int] = field(default_factory=list)
    periods: list[int] = field(default_factory=list)

    @property
    def longest(self) -> int | None:
        """The longest of the last periods, samples; None while there is none."""
        return max(self.periods) if self.periods else None

    def see(self, value: float) -> None:
        """Take in the next value; one that is not finite only takes time."""
        self.samples += 1
        self.since += 1
        if not math.isfinite(value):
            return
        if math.isnan(self.low):
            self.low = self.high = value
            return
        if value > self.high:
            self.high = value
            if self.direction > 0:
                self.since = 0
        elif value < self.low:
            self.low = value
            if self.direction < 0:
                self.since = 0
        self._turn(value)
        if self.longest is not None and self.samples > _PATIENCE * self.longest:
            self.ways, self.halves = [], []
            self.low = self.high = value
            self.samples = self.since = self.direction = 0

    def numbers(self) -> dict[str, Any]:
        """Give what ``from_numbers`` understands, numbers and lists of them."""
        ends = [] if math.isnan(self.low) else [self.low, self.high]
        return {
            "counts": [self.samples, self.since, self.direction],
            "ends": ends,
            "ways": list(self.ways),
            "halves": list(self.halves),
            "periods": list(self.periods),
        }

    @classmethod
    def from_numbers(cls, numbers: dict[str, Any]) -> PeriodWatch:
        """Rebuild a watch.

        Raises
        ------
        InputError
            If it is none that can have been.
        """
        samples, since, direction = (int(each) for each in numbers["counts"])
        ends = [float(each) for each in numbers["ends"]] or [math.nan, math.nan]
        ways = [float(each) for each in numbers["ways"]]
        halves, periods = _counts(numbers["halves"]), _counts(numbers["periods"])
        is_possible = 0 <= since <= samples and direction in (-1, 0, 1) and not ends[0] > ends[1]
        if not is_possible or min([*ways, *halves, *periods], default=0) < 0:
            raise InputError("the saved watch of the motion has counts out of range; save it again")
        return cls(samples, since, direction, ends[0], ends[1], ways, halves, periods)

    def _turn(self, value: float) -> None:
        way = self.high - self.low
        band = _BACK * max([way, *self.ways])
        if self.direction == 0:
            if way > 0.0 and value in (self.low, self.high):
                self.direction, self.since = (1 if value == self.high else -1), 0
            return
        back = self.high - value if self.direction > 0 else value - self.low
        if not back > band or not band > 0.0:
            return
        half = self.samples - self.since
        self.ways = [*self.ways, way][-_HALVES:]
        self.halves = [*self.halves, half][-_HALVES:]
        # The first one began somewhere between two turns.
        if len(self.halves) >= 3:
            self.periods = [*self.periods, self.halves[-1] + self.halves[-2]][-_PERIODS:]
        self.samples = self.since
        # From the turn on; what it has gone back since then is between it and this value.
        self.direction = -self.direction
        if self.direction < 0:
            self.low = value
        else:
            self.high = value
        self.since = 0


def _counts(values: Sequence[float]) -> list[int]:
    return [int(each) for each in values]
