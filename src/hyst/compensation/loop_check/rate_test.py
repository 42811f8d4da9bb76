"""Whether loops depend on the frequency, and what it looks like when they do."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.compensation.loop_check.coincidence import Coincidence, coincidence
from hyst.compensation.loop_check.delay_between import remaining_delay
from hyst.compensation.loop_check.loop_shape import LoopShape
from hyst.compensation.loop_check.repeated_cycles import RepeatedCycles

Array = NDArray[np.float64]

SAME_FREQUENCY = 0.02
"""By which frequencies may differ and be one; also lowest and highest input of comparable loops."""

_EXPLAINED = 0.15  # of the distance: a cause that leaves less is the cause

COINCIDE, SMALL, DELAY, CREEP, LAG = "coincide", "small", "delay", "creep", "lag"
GAIN, WIDER, NARROWER, SHAPE, CHANGED = "gain", "wider", "narrower", "shape", "changed"
CAUSES = (COINCIDE, SMALL, DELAY, CREEP, LAG, GAIN, WIDER, NARROWER, SHAPE, CHANGED)


@dataclass(frozen=True, eq=False)
class RepeatedLoop:
    """The loop of a stretch in which the input repeats.

    Parameters
    ----------
    record
        Index of its record, from 0.
    cycles
        The stretch.
    shape
        Its harmonics.
    """

    record: int
    cycles: RepeatedCycles
    shape: LoopShape

    @property
    def frequency(self) -> float:
        """Cycles a second, Hz."""
        return self.cycles.frequency

    @property
    def ratio(self) -> complex:
        """Give the first harmonic of v over that of the model: 1 where the model is right."""
        (a, b), (own, behind) = self.shape.seen[0], self.shape.modelled[0]
        below = complex(own, -behind)
        return complex(a, -b) / below if below else complex(math.nan, math.nan)

    @property
    def area(self) -> float:
        """Area of the loop, units of u times units of v."""
        return self._area(self.shape.seen)

    @property
    def modelled_area(self) -> float:
        """The same of the model."""
        return self._area(self.shape.modelled)

    @property
    def area_standard_error(self) -> float:
        """Standard error of the area."""
        half = 0.5 * (self.cycles.high - self.cycles.low)
        return math.pi * half * math.sqrt(float(self.shape.variance[0]))

    def _area(self, harmonics: Array) -> float:
        return math.pi * 0.5 * (self.cycles.high - self.cycles.low) * float(harmonics[0, 1])


@dataclass(frozen=True, eq=False)
class RateTest:
    """Loops of one amplitude and offset at several frequencies, compared.

    Parameters
    ----------
    loops
        The loops, of ascending frequency.
    found
        How well they coincide.
    extent
        Range of v by the model, which percentages refer to.
    delay
        s, by which v still comes late: of all causes the one that is tried first.
    without_delay
        How well they coincide when it is taken back.
    cause
        One of ``CAUSES``.
    dt
        Sample time, s.
    """

    loops: tuple[RepeatedLoop, ...]
    found: Coincidence
    extent: float
    delay: float
    without_delay: Coincidence
    cause: str
    dt: float

    @property
    def distance_percent(self) -> float:
        """Distance of the two loops furthest apart, % of range."""
        return 100.0 * self.found.distance / self.extent

    @property
    def holds(self) -> bool:
        """Whether the loops coincide, or differ by less than matters."""
        return self.cause in (COINCIDE, SMALL)


def comparable(loops: Sequence[RepeatedLoop]) -> list[tuple[RepeatedLoop, ...]]:
    """Put loops together whose inputs turn at the same values, by frequency.

    Parameters
    ----------
    loops
        All there are.

    Returns
    -------
    list of tuple
        Only those of two loops or more, and of more than one frequency.
    """
    groups: list[list[RepeatedLoop]] = []
    for each in sorted(loops, key=lambda loop: loop.frequency):
        for group in groups:
            if _turn_alike(each.cycles, group[0].cycles):
                group.append(each)
                break
        else:
            groups.append([each])
    return [tuple(group) for group in groups if len(_by_frequency(group)) > 1]


def _turn_alike(one: RepeatedCycles, other: RepeatedCycles) -> bool:
    room = SAME_FREQUENCY * (other.high - other.low)
    return abs(one.low - other.low) <= room and abs(one.high - other.high) <= room


def _by_frequency(loops: Sequence[RepeatedLoop]) -> list[list[RepeatedLoop]]:
    groups: list[list[RepeatedLoop]] = []
    for each in loops:
        if groups and each.frequency <= (1.0 + SAME_FREQUENCY) * groups[-1][0].frequency:
            groups[-1].append(each)
        else:
            groups.append([each])
    return groups


def rate_test(
    loops: tuple[RepeatedLoop, ...], extent: float, level: float, tolerance: float, dt: float
) -> RateTest:
    """Test whether loops coincide, and find what their differences look like.

    Parameters
    ----------
    loops
        Comparable ones, by frequency.
    extent
        Range of v.
    level
        Chance to call loops different that differ by noise alone.
    tolerance
        Distance that does not matter, % of range.
    dt
        Sample time, s.
    """
    common = min(len(each.shape.beside) for each in loops)
    loops = tuple(replace(each, shape=each.shape.up_to(common)) for each in loops)
    found = _compared(loops, [each.shape.beside for each in loops])
    shapes = [each.shape for each in loops]
    delay, ahead = remaining_delay(shapes, [each.cycles for each in loops], dt)
    without = _compared(loops, ahead)
    small = 0.01 * tolerance * extent
    cause = COINCIDE
    if found.p_value < level:
        explained = without.p_value >= level or without.distance <= _EXPLAINED * found.distance
        if found.distance <= small:
            cause = SMALL
        elif _changed(loops, level, small):
            cause = CHANGED
        else:
            cause = DELAY if explained else _looks_like(loops)
    return RateTest(loops, found, extent, delay, without, cause, dt)


def _compared(loops: Sequence[RepeatedLoop], means: Sequence[Array]) -> Coincidence:
    return coincidence(
        means, [each.shape.variance for each in loops], [each.shape.freedom for each in loops]
    )


def _changed(loops: Sequence[RepeatedLoop], level: float, small: float) -> bool:
    """Tell whether loops of one frequency already differ, so that it is not the rate."""
    for group in _by_frequency(loops):
        if len(group) > 1:
            found = _compared(group, [each.shape.beside for each in group])
            if found.p_value < level and found.distance > small:
                return True
    return False


def _looks_like(loops: Sequence[RepeatedLoop]) -> str:
    beside = np.array([each.shape.beside for each in loops])
    in_phase, behind = beside[:, 0, 0], beside[:, 0, 1]
    sign = 1.0 if float(np.mean([each.shape.modelled[0, 0] for each in loops])) >= 0.0 else -1.0
    gain_grows, width_grows = _slope(loops, sign * in_phase), _slope(loops, sign * behind)
    further = np.ptp(beside[:, 1:], axis=0)
    if np.sqrt(np.square(further).sum()) > max(np.ptp(in_phase), np.ptp(behind)):
        return SHAPE
    if np.ptp(in_phase) < np.ptp(behind):
        return WIDER if width_grows > 0.0 else NARROWER
    if gain_grows < 0.0 and width_grows < 0.0 and _from_the_slowest_on(loops, in_phase):
        return CREEP
    # A part of the change that goes with the width is a lag's; gain alone is the dynamics'.
    both = np.ptp(behind) > 0.3 * np.ptp(in_phase)
    return LAG if gain_grows < 0.0 < width_grows and both else GAIN


def _slope(loops: Sequence[RepeatedLoop], values: Array) -> float:
    at = np.log([each.frequency for each in loops])
    return float(np.dot(at - at.mean(), values))


def _from_the_slowest_on(loops: Sequence[RepeatedLoop], values: Array) -> bool:
    """Tell whether values change with the logarithm of the frequency more than with its square.

    Slow relaxation shows at the lowest frequencies, a wrong resonance at the highest; two loops do
    not tell.
    """
    f = np.array([each.frequency for each in loops])
    if len(_by_frequency(loops)) < 3:
        return False
    left = [
        float(np.square(values - np.polyval(np.polyfit(at, values, 1), at)).sum())
        for at in (np.log(f / f[-1]), np.square(f / f[-1]))
    ]
    return left[0] < left[1]
