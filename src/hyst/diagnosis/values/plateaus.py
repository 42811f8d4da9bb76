"""Plateaus: an output that stands at its end while the input goes on and comes back."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.values.runs import runs_where
from hyst.signals import estimate_noise

Array = NDArray[np.float64]
Samples = NDArray[np.intp]

_SHORTEST = 4
_FEWEST = 8
_FEWEST_NOISY = 40
_FEWEST_VALUES = 24
_LEAST_OVER = 0.02
_LEAST_NOISE = 1e-7
_MOST_NOISE = 0.005
_FLANK = 0.1
_LEAST_SLOPE = 0.35
_MOST_BEND = 1.5
_MOST_ROUNDING = 0.1
_INSIDE = 200
_MOST_OPENING = 1.6
_LEAST_OPENING = 0.04
_BAND = 4.5
_TREND = 3.0


@dataclass(frozen=True, eq=False)
class Plateau:
    """One level at which the output stands.

    Parameters
    ----------
    level
        In units of the output.
    samples
        Shape (m,), all samples on it, ascending.
    moved
        By how much the input moves at most while the output stands, in its units.
    is_upper
        Whether it is the highest value and not the lowest.
    """

    level: float
    samples: Samples
    moved: float
    is_upper: bool


@dataclass(frozen=True, eq=False)
class _End:
    """A signal that may stand at the level 0, its highest, and what drives it.

    Parameters
    ----------
    depth
        Shape (N,), how far below the level the signal is, in shares of its range.
    cause
        Shape (N,), in shares of its range.
    band
        Depths up to this one are on the level.
    flank
        Depth down to which the slopes on either side are judged.
    """

    depth: Array
    cause: Array
    band: float
    flank: float


def plateaus_in(signal: Array, cause: Array, step: float = 0.0) -> tuple[Plateau, ...]:
    """Find the levels at which a sensor is at its end.

    The output comes to the level on a slope and leaves it on a slope; in between the input goes on
    by at least 2 % of its range and comes back to about where the plateau began. A play stands
    still from the turn of its input, a stop up to the turn, a saturating material comes to its
    level or leaves it ever more slowly, a switch jumps: none of them is a sensor at its end.
    The level is a value taken to the bit, or one with the noise of the signal around it.

    Parameters
    ----------
    signal, cause
        Output and input, shape (N,), finite.
    step
        Of the converter, in units of the signal, 0 if there is none.

    Returns
    -------
    tuple of Plateau
        At most one at either end of the range, the upper one first.
    """
    spread, stroke = float(np.ptp(signal)), float(np.ptp(cause))
    # Few values: a switch, which stands by its nature.
    if spread == 0.0 or stroke == 0.0 or np.unique(signal).size < _FEWEST_VALUES:
        return ()
    shares = (signal - signal.min()) / spread
    causes = (cause - cause.min()) / stroke
    noise = estimate_noise(shares)
    found = []
    for is_upper in (True, False):
        height = shares if is_upper else 1.0 - shares
        samples, moved = _standing(height, causes, step / spread, noise)
        if samples.size:
            level = float(np.median(signal[samples]))
            found.append(Plateau(level, samples, moved * stroke, is_upper))
    return tuple(found)


def _standing(height: Array, cause: Array, step: float, noise: float) -> tuple[Samples, float]:
    """Give the samples on the upper level and the largest motion of the input meanwhile."""
    exact = _End(height.max() - height, cause, 0.0, max(_FLANK, 5.0 * step))
    samples, moved = _judged(exact)
    if samples.size or not _LEAST_NOISE < noise < _MOST_NOISE:
        return samples, moved
    # The mean of the highest values is too high by little; once more around it.
    level = float(np.mean(height[height > height.max() - 5.0 * noise]))
    near = np.abs(height - level) < 3.0 * noise
    level = float(np.mean(height[near])) if np.any(near) else level
    blurred = replace(
        exact, depth=level - height, band=_BAND * noise, flank=max(exact.flank, 20.0 * noise)
    )
    return _judged(blurred, noise)


def _judged(end: _End, noise: float = 0.0) -> tuple[Samples, float]:
    """Give the samples on the level and the largest motion if most runs are those of a sensor."""
    on_level = end.depth <= end.band
    nothing = np.empty(0, dtype=np.intp), 0.0
    first, last = runs_where(on_level)
    worth = (last - first + 1 >= _SHORTEST) & (first > 0) & (last < end.depth.size - 1)
    over, trends, against = [], [], 0
    for begin, stop in zip(first[worth].tolist(), last[worth].tolist(), strict=True):
        moved = _motion(end, begin, stop)
        if moved < max(_LEAST_OVER, 3.0 * end.band):
            continue
        trend = _trend(end, begin, stop, noise) if noise else 0.0
        if math.isfinite(trend) and _has_slopes(end, begin, stop):
            over.append(moved)
            trends.append(trend)
        else:
            against += 1
    samples = np.flatnonzero(on_level)
    fewest = _FEWEST_NOISY if noise else _FEWEST
    if len(over) <= against or samples.size < fewest:
        return nothing
    if abs(sum(trends)) > _TREND * math.sqrt(len(trends)):
        return nothing
    if sum(map(abs, trends)) > _TREND / 2.0 * len(trends):
        return nothing
    return samples, max(over)


def _motion(end: _End, begin: int, stop: int) -> float:
    """How far the input goes on beyond where a run began, in the direction it came."""
    direction = _direction(end, begin)
    return float(np.max(direction * (end.cause[begin : stop + 1] - end.cause[begin])))


def _direction(end: _End, begin: int) -> float:
    """Which way the input went while the output came up to the level."""
    foot = _foot(end, begin, -1)
    return 0.0 if foot is None else math.copysign(1.0, end.cause[begin] - end.cause[foot])


def _foot(end: _End, place: int, way: int, share: float = 1.0) -> int | None:
    """Nearest sample before (-1) or behind (1) a run at which the flank, or a share, is passed."""
    reach = 64
    while True:
        near = end.depth[place::way][:reach]
        below = np.flatnonzero(near > share * end.flank)
        if below.size:
            return place + way * int(below[0])
        if near.size < reach:
            return None
        reach *= 4


def _has_slopes(end: _End, begin: int, stop: int) -> bool:
    """Whether the output comes up a slope, the input comes back, and the output goes down one."""
    direction = _direction(end, begin)
    over = _motion(end, begin, stop)
    width = direction * float(end.cause[begin] - end.cause[stop])
    if width < -over / 2.0 or width > 2.0 * over:
        return False
    if not _loop_is_as_wide_below(end, begin, stop, direction * width):
        return False
    return _is_slope(end, begin, -1, direction) and _is_slope(end, stop, 1, direction)


def _loop_is_as_wide_below(end: _End, begin: int, stop: int, width: float) -> bool:
    """Whether the loop does not open out of the level as that of a saturating material does."""
    before, behind = _foot(end, begin, -1), _foot(end, stop, 1)
    if before is None or behind is None:
        return False
    below = float(end.cause[before] - end.cause[behind])
    return abs(below) <= _MOST_OPENING * abs(width) + _LEAST_OPENING


def _is_slope(end: _End, place: int, way: int, direction: float) -> bool:
    """Whether the output goes down from an end of a run steeply, straight, and without a jump."""
    half, foot = _crossing(end, place, way, 0.5), _crossing(end, place, way)
    if half is None or foot is None or _jumps(end, place, way):
        return False
    start = float(end.cause[place + way])
    upper, lower = direction * (start - half), direction * (half - foot)
    travel = direction * (float(end.cause[place]) - foot)
    if not 0.0 <= travel <= end.flank / _LEAST_SLOPE:
        return False
    # A material that saturates takes far more input for the upper half than for the lower.
    if upper > _MOST_BEND * lower:
        return False
    return end.band == 0.0 or _has_corner(end, place, way, 2.0 * half - foot, abs(lower))


def _crossing(end: _End, place: int, way: int, share: float = 1.0) -> float | None:
    """Input at which the flank, or a share of it, is passed before (-1) or behind (1) a run."""
    foot = _foot(end, place, way, share)
    if foot is None:
        return None
    inner, outer = end.depth[foot - way], end.depth[foot]
    weight = float((share * end.flank - inner) / (outer - inner))
    return float((1.0 - weight) * end.cause[foot - way] + weight * end.cause[foot])


def _has_corner(end: _End, place: int, way: int, corner: float, reach: float) -> bool:
    """Whether noisy samples near the input at which the flank meets the level are on it."""
    nearby = slice(max(place - _INSIDE, 0), place + _INSIDE)
    inside = way * (np.arange(end.depth.size)[nearby] - place) <= 1
    near = inside & (np.abs(end.cause[nearby] - corner) <= reach / 2.0)
    beyond = (end.cause[nearby] - corner) * (end.cause[place] - end.cause[place + way]) >= 0.0
    depths = end.depth[nearby][near & beyond]
    if depths.size == 0:
        return False
    allowed = _MOST_ROUNDING * end.flank + 2.0 * end.band / _BAND / math.sqrt(depths.size)
    return float(depths.mean()) <= allowed


def _jumps(end: _End, place: int, way: int) -> bool:
    """Whether the signal comes to a run, or leaves it, by more than the way it has there."""
    moves = np.abs(np.diff(end.depth[place::way][:8]))
    return bool(moves[0] > 3.0 * np.max(moves[1:], initial=0.0) + 2.0 * end.band)


def _trend(end: _End, begin: int, stop: int, noise: float) -> float:
    """How much a run still rises with the input, in standard errors; infinite if it scatters."""
    direction = _direction(end, begin)
    travel = direction * (end.cause[begin : stop + 1] - end.cause[begin])
    far = travel > 0.2 * travel.max()
    depth, travel = end.depth[begin : stop + 1][far], travel[far]
    scatter = float(depth.std())
    spread = float(np.sum((travel - travel.mean()) ** 2))
    if depth.size < 12 or spread == 0.0 or scatter > 1.5 * noise:
        return math.inf
    slope = float((travel - travel.mean()) @ depth) / spread
    return slope * math.sqrt(spread) / noise
