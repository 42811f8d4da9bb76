"""The loop of a model over the range of its record: how steep, how open, how bent."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.operators import Operator

Array = NDArray[np.float64]

POINTS = 33
"""Of the grid of the drive on which loops are told."""

_SHORTEST, _LONGEST = 4 * (POINTS - 1), 3000
"""Samples of a stroke; a record's own where it is between."""


@dataclass(frozen=True, eq=False)
class ModelLoop:
    """A loop from the lowest to the highest drive and back.

    Parameters
    ----------
    rising, falling
        Output at an even grid of the drive, shape (POINTS,).
    stroke
        Highest minus lowest drive, > 0.
    """

    rising: Array
    falling: Array
    stroke: float

    @property
    def height(self) -> float:
        """Highest minus lowest output."""
        both = np.concatenate((self.rising, self.falling))
        return float(np.ptp(both))

    @property
    def gain(self) -> float:
        """Rise from the lower to the upper end, over the stroke."""
        ends = self.rising + self.falling
        return float(0.5 * (ends[-1] - ends[0]) / self.stroke)

    @property
    def width(self) -> Array:
        """Falling minus rising branch, shares of the height; as signs are for a rising gain."""
        return (self.falling - self.rising) / (self.height or 1.0)

    @property
    def bend(self) -> Array:
        """Middle of the branches minus the line between the ends, shares of the height."""
        middle = 0.5 * (self.rising + self.falling)
        line = np.linspace(middle[0], middle[-1], POINTS)
        return (middle - line) / (self.height or 1.0)

    def normalized(self) -> tuple[Array, Array]:
        """Give both branches from 0 to 1."""
        low = min(self.rising.min(), self.falling.min())
        height = self.height or 1.0
        return (self.rising - low) / height, (self.falling - low) / height


def loop_of_model(model: Operator, u: Array, dt: float) -> ModelLoop:
    """Run a model over the range of a record, at the record's mean speed, until the loop repeats.

    Parameters
    ----------
    model
        To run.
    u
        Drive of its record, not constant.
    dt
        Sample time of the record, s.
    """
    low, high = float(u.min()), float(u.max())
    speed = float(np.mean(np.abs(np.diff(u))))
    samples = int(np.clip((high - low) / speed, _SHORTEST, _LONGEST)) if speed else _SHORTEST
    up = np.linspace(low, high, samples + 1)
    down = up[-2:0:-1]
    strokes = np.concatenate((up, down, up, down, up, down, up[:1]))
    y = model.at_sample_time(dt)(strokes)
    last = y[-(2 * samples + 1) :]
    grid = np.linspace(low, high, POINTS)
    rising = np.interp(grid, up, last[: samples + 1])
    falling = np.interp(grid, up, last[samples:][::-1])
    return ModelLoop(rising, falling, high - low)
