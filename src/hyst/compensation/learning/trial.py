"""A repetition as learning sees it, and how it compares with the best one."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

Comparison = Literal["better", "alike", "worse", "changed", "unlike"]

_WORSE = 1.15
"""Times the best error: from here on a repetition is worse, if noise does not explain it."""

_ABOVE_NOISE = 1.4
"""Times the noise: below, errors are not told apart."""

_UNEXPLAINED = 10.0
"""Times the change of what the model was told: a plant that changes its output by more has changed
itself. No mode of ordinary damping passes that much over a whole motion."""


_EXPLAINED = 0.5
"""Of what is unexpected: what a gain and an offset must leave at most to be what has changed."""

_LEAST, _MOST = 0.5, 2.0
"""Gains that a plant is believed to have come to, over the one before."""


@dataclass(frozen=True, eq=False)
class Trial:
    """What the model gives for an applied input, what came of it, and what was missed.

    Parameters
    ----------
    number
        Of the repetition.
    u, v, y, error
        Shape (N,).
    """

    number: int
    u: Array
    v: Array
    y: Array
    error: Array

    @property
    def rms(self) -> float:
        """Of the error."""
        return math.sqrt(float(np.mean(self.error**2)))

    @property
    def largest(self) -> float:
        """Of the error."""
        return float(np.abs(self.error).max())

    def against(self, best: Trial, expected: Array, noise: float) -> Comparison:
        """Compare with the best repetition.

        ``"changed"``: by a gain and an offset; ``"unlike"``: by more than the command explains, and
        not by these.

        Parameters
        ----------
        best
            The best one so far.
        expected
            What that and the change of the command lead to expect, shape (N,).
        noise
            Rms of what does not repeat.
        """
        if self.rms < best.rms:
            return "better"
        if self.rms < max(_WORSE * best.rms, _ABOVE_NOISE * noise):
            return "alike"
        surprise = math.sqrt(float(np.mean((self.y - expected) ** 2)))
        moved = math.sqrt(float(np.mean((self.v - best.v) ** 2)))
        if surprise <= _UNEXPLAINED * moved + 2.0 * noise:
            return "worse"
        gain, left = self.gain_over(expected)
        explained = left < _EXPLAINED * surprise + noise
        return "changed" if explained and _LEAST < gain < _MOST else "unlike"

    def gain_over(self, expected: Array) -> tuple[float, float]:
        """Give the gain of what was measured over what was expected, and the rms it leaves."""
        own, told = self.y - self.y.mean(), expected - expected.mean()
        way = float(told @ told)
        gain = float(own @ told) / way if way > 0.0 else 1.0
        return gain, math.sqrt(float(np.mean((own - gain * told) ** 2)))

    def to_dict(self) -> dict[str, Any]:
        """Give plain numbers."""
        return {
            "number": self.number,
            **{name: getattr(self, name).tolist() for name in ("u", "v", "y", "error")},
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Trial:
        """Rebuild it from ``to_dict()``.

        Parameters
        ----------
        data
            What it gave.
        """
        arrays = (np.array(data[name], dtype=float) for name in ("u", "v", "y", "error"))
        return cls(int(data["number"]), *arrays)
