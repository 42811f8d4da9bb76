"""What a fit leaves, taken apart into causes with a name, what repeats, and noise."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.judgement.cause import Cause, Contribution
from hyst.identification.judgement.causes.another_shape import ANOTHER_SHAPE
from hyst.identification.judgement.outliers import outliers_of
from hyst.identification.judgement.registry import CAUSES
from hyst.identification.judgement.regression import Regression, chance, correlation_time, is_white
from hyst.identification.judgement.remainder import Remainder
from hyst.identification.judgement.repetition import period_of, repeating

Array = NDArray[np.float64]

SMALLEST_SHARE = 0.08
"""Of the squared error: what explains less is not told, the error would be 4 % smaller without."""

SMALLEST_PART = 5e-4
"""Of the output's range: a smaller rms is not told, whatever it is."""

UNLIKELY = 1e-5
"""Probability that noise alone looks like a cause."""

ABOUT_THE_SAME = 0.95
BEYOND_LOOPS = 0.5
"""Share of what a cause explains that general loops must not explain as well."""

BESIDE_ANOTHER_SHAPE = 0.75
"""Share of what is left that such a cause must explain once the loops are of another shape: what
general loops miss looks like much."""

SMALLEST_OF_THE_REST = 0.25
"""Share of what is left that a further cause must explain: small ones may resemble many things."""

TANGENT, LINE, SHAPE = "tangent", "line", ANOTHER_SHAPE.name


@dataclass(frozen=True, eq=False)
class TakenApart:
    """What a fit leaves, by causes.

    Parameters
    ----------
    named
        The causes that explain a share worth telling, in the order in which they were found.
    outliers
        Number of samples far from their neighbours, and share of the squared error they make.
    noise
        Rms of what no cause explains.
    sensor
        Rms of what of it is certainly noise: all, or where it is not white what changes from one
        sample to the next.
    undisturbed, line, spread
        Rms that the model, a straight line and the mean would leave of a record without outliers
        and without what comes to the output from elsewhere.
    repeats
        Rms of the part of the noise that repeats with the drive and is worth telling; else 0.
    period_known
        Whether the drive repeats, so that noise is what does not.
    white
        Whether the noise tells nothing of the samples after.
    """

    named: tuple[tuple[Cause, Contribution], ...]
    outliers: tuple[int, float]
    noise: float
    sensor: float
    undisturbed: float
    line: float
    spread: float
    repeats: float
    period_known: bool
    white: bool

    @property
    def is_noise(self) -> bool:
        """Whether what no cause explains is known to be the record's own noise."""
        return self.white or (self.period_known and not self.repeats)


def taken_apart(remainder: Remainder) -> TakenApart:
    """Find the causes of what a fit leaves.

    Parameters
    ----------
    remainder
        What the fit leaves.
    """
    outside = outliers_of(remainder)
    inner = ~outside[remainder.rows]
    error = remainder.error
    share = float(error[outside] @ error[outside]) / float(error @ error)
    groups = _groups(remainder, inner)
    regression = Regression(error[remainder.rows][inner], groups)
    time = correlation_time(regression.rest(list(groups)))
    named = _named(regression, groups, time, SMALLEST_PART * remainder.output_range)
    taken = [TANGENT, *(cause.name for cause, _ in named)]
    rest = regression.rest(taken)
    freedom = max(rest.size - regression.left(taken)[1] - 1, 1)
    noise = math.sqrt(float(rest @ rest) / freedom)
    repeats, known = _repeats(remainder, rest, inner, len(groups))
    told = _told(remainder, regression, named)
    disturbing = [cause.name for cause, _ in named if cause.disturbs]
    y = Regression(
        remainder.y[remainder.rows][inner],
        groups | {LINE: remainder.u[remainder.rows][inner, None]},
    )
    shape = max((each.rms for cause, each in told if cause.name == SHAPE), default=0.0)
    smallest = SMALLEST_PART * remainder.output_range
    whole, noise = noise, math.sqrt(max(noise**2 - repeats**2, 0.0))
    if repeats < max(shape, math.sqrt(SMALLEST_SHARE) * whole, smallest):
        repeats = 0.0  # not worth telling beside the shape; it is no noise for that
    white = is_white(rest)
    return TakenApart(
        told,
        (int(outside.sum()), share),
        noise,
        noise if white or (known and not repeats) else min(noise, _from_neighbours(rest)),
        regression.rms([TANGENT, *disturbing] if disturbing else []),
        y.rms([LINE, *disturbing]),
        y.rms(disturbing),
        repeats,
        known,
        white,
    )


def _from_neighbours(rest: Array) -> float:
    """Give the rms of the white noise that second differences of an error allow."""
    if rest.size < 3:
        return 0.0
    return float(np.sqrt(np.mean(np.diff(rest, 2) ** 2) / 6.0))


def _groups(remainder: Remainder, inner: NDArray[np.bool_]) -> dict[str, Array]:
    """Give the columns of the model's own freedom and of all causes over the rows in use."""
    tangent = remainder.tangent
    own = tangent if tangent.shape[1] else remainder.u[remainder.rows, None]
    groups = {TANGENT: own} | {each.name: each.columns(remainder) for each in CAUSES}
    return {name: each[inner] for name, each in groups.items() if each.shape[1]}


def _named(
    regression: Regression, groups: Mapping[str, Array], time: float, smallest: float
) -> list[tuple[Cause, float]]:
    """Take one cause after the other, that which explains most first, with its share."""
    n, total = regression.error.size, regression.total
    least = max(SMALLEST_SHARE, smallest**2 * n / total if total > 0.0 else 1.0)
    result: list[tuple[Cause, float]] = []
    remaining = [each for each in CAUSES if each.name in groups]
    while remaining:
        taken = [TANGENT, *(cause.name for cause, _ in result)]
        gains = [_gain(regression, taken, each, time) for each in remaining]
        if result:
            least = max(least, SMALLEST_OF_THE_REST * regression.left(taken)[0])
        if max(gains) < least:
            break
        counted = [
            gain * each.counts * (gain >= least)
            for gain, each in zip(gains, remaining, strict=True)
        ]
        best = max(counted)
        at = next(i for i, gain in enumerate(counted) if gain >= ABOUT_THE_SAME * best)
        result.append((remaining.pop(at), gains[at]))
    return result


def _gain(regression: Regression, taken: list[str], cause: Cause, time: float) -> float:
    """Give the share of the squared error that a cause explains beyond those taken, and noise."""
    gain = _over_noise(regression, taken, cause.name, time)
    if gain == 0.0 or not cause.beyond_loops:
        return gain
    if SHAPE in taken:
        return gain if gain >= BESIDE_ANOTHER_SHAPE * regression.left(taken)[0] else 0.0
    beyond = _over_noise(regression, [*taken, SHAPE], cause.name, time)
    return gain if beyond >= BEYOND_LOOPS * gain else 0.0


def _over_noise(regression: Regression, taken: list[str], name: str, time: float) -> float:
    n = regression.error.size
    before, known = regression.left(taken)
    after, directions = regression.left([*taken, name])
    freedom = (n - directions - 1) / time
    if chance(before, after, directions - known, freedom) > UNLIKELY:
        return 0.0
    by_noise = (directions - known) * time * after / max(n - directions, 1)
    return before - after - by_noise


def _told(
    remainder: Remainder, regression: Regression, named: list[tuple[Cause, float]]
) -> tuple[tuple[Cause, Contribution], ...]:
    """Give every cause with its size, found beside those before it: later ones may resemble it."""
    result = []
    for count, (cause, gain) in enumerate(named, 1):
        beside = list(dict.fromkeys([TANGENT, SHAPE, *(each.name for each, _ in named[:count])]))
        rms = math.sqrt(gain * regression.total / regression.error.size)
        coefficients = regression.coefficients(beside, cause.name)
        result.append((cause, Contribution(remainder, coefficients, rms, gain)))
    return tuple(result)


def _repeats(
    remainder: Remainder, rest: Array, inner: NDArray[np.bool_], groups: int
) -> tuple[float, bool]:
    """Give the rms of what repeats with the drive, and whether any drive repeats."""
    rows = remainder.rows[inner]
    first, squares, known = 0, 0.0, False
    for part in remainder.parts:
        here = slice(*np.searchsorted(rows, [first, first + part.u.size]))
        period = period_of(part)
        if period:
            known = True
            squares += repeating(rest[here], rows[here] - first, period, UNLIKELY)
        first += part.u.size
    return math.sqrt(squares / max(rest.size, 1)), known
