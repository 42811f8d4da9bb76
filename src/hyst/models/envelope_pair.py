"""Two piecewise linear envelopes: where they are closest, flat and steepest."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.models.piecewise_map import PiecewiseMap
from hyst.operators import DeadZone

Array = NDArray[np.float64]

_ROUNDING = 1e-12
"""Of the weights of a map: a slope below that is 0 to all that is known."""


def as_envelope(envelope: Any, name: str) -> DeadZone:
    """Check that a map can be an envelope of rising or falling input.

    Parameters
    ----------
    envelope
        A two-sided dead-zone map that nowhere falls.
    name
        What messages call it.

    Returns
    -------
    DeadZone
        ``envelope`` itself.

    Raises
    ------
    InputError
        If it is none.
    """
    if not isinstance(envelope, DeadZone) or envelope.variant != "two-sided":
        what = getattr(envelope, "kind", type(envelope).__name__)
        raise InputError(f"{name} is a {what}; give a two-sided DeadZone")
    slopes, ends = _slopes(envelope, _pieces(envelope))
    wrong = np.flatnonzero(slopes < -_ROUNDING * float(np.abs(envelope.weights).sum()))
    if wrong.size:
        i = int(wrong[0])
        raise InputError(
            f"{name} falls from {ends[i]:.6g} to {ends[i + 1]:.6g}, its slope there is "
            f"{slopes[i]:.6g}; give an envelope that nowhere falls"
        )
    return envelope


@final
@dataclass(frozen=True, eq=False)
class EnvelopePair:
    """The envelope of rising input and that of falling input.

    Parameters
    ----------
    rising, falling
        Two-sided dead-zone maps.
    """

    rising: DeadZone
    falling: DeadZone

    def narrowest(self) -> tuple[float, float]:
        """Give where ``falling - rising`` is least, and how much it is there.

        Returns
        -------
        tuple of float
            Input units, an infinity where the difference falls without end; and the difference.
        """
        ends = _pieces(self.rising, self.falling)
        places = np.append(ends[1:-1], 0.0)
        gaps = self.falling(places) - self.rising(places)
        change = _slopes(self.falling, ends)[0] - _slopes(self.rising, ends)[0]
        slack = _ROUNDING * float(
            np.abs(self.rising.weights).sum() + np.abs(self.falling.weights).sum()
        )
        if change[-1] < -slack:
            return np.inf, -np.inf
        if change[0] > slack:
            return -np.inf, -np.inf
        least = int(np.argmin(gaps))
        return float(places[least]), float(gaps[least])

    def flat_from(self) -> tuple[float, float] | None:
        """Give the first piece on which the mean of both does not rise, or None."""
        ends, slopes, scale = self._mean()
        flat = np.flatnonzero(slopes <= _ROUNDING * scale)
        return (float(ends[flat[0]]), float(ends[flat[0] + 1])) if flat.size else None

    def steepest(self) -> float:
        """Give the steepest slope of either."""
        ends = _pieces(self.rising, self.falling)
        return max(float(_slopes(each, ends)[0].max()) for each in (self.rising, self.falling))

    def steepest_mean(self) -> float:
        """Give the steepest slope of the mean."""
        return float(self._mean()[1].max())

    def mean_slope_at_zero(self) -> float:
        """Give the slope of the mean around 0."""
        return 0.5 * sum(
            float(each.weights[each.thresholds == 0.0].sum())
            for each in (self.rising, self.falling)
        )

    def _mean(self) -> tuple[Array, Array, float]:
        ends = _pieces(self.rising, self.falling)
        slopes = 0.5 * (_slopes(self.rising, ends)[0] + _slopes(self.falling, ends)[0])
        return ends, slopes, float(np.abs(slopes).max())


def _pieces(*maps: DeadZone) -> Array:
    """Give the ends of the pieces on which all maps are straight, infinities included.

    0 is an end, too, which no map needs, so that there is always one.
    """
    inner = np.unique(np.concatenate([[0.0], *(each.thresholds for each in maps)]))
    return np.concatenate([[-np.inf], inner, [np.inf]])


def _slopes(envelope: DeadZone, ends: Array) -> tuple[Array, Array]:
    """Give the slopes of a map on pieces, and their ends."""
    inner = ends[1:-1]
    middles = 0.5 * (inner[1:] + inner[:-1])
    # Beyond the last thresholds any point will do; the pieces' own width keeps the scale.
    reach = 1.0 if inner.size == 1 else float(inner[-1] - inner[0])
    points = np.concatenate([[inner[0] - reach], middles, [inner[-1] + reach]])
    return PiecewiseMap((envelope,)).slope(points), ends
