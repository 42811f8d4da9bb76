"""What samples that have left the window tell: a quadratic of the constants that is forgotten."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

Array = NDArray[np.float64]

# Information may fade this much faster than it comes in: what a smaller drive still tells counts
# in the end as what it is, what no drive tells does not fade at all.
_FASTER = 10.0


@final
@dataclass(frozen=True, eq=False)
class Past:
    """Squares of the errors of the past: ``x' A x - 2 b' x`` and a constant.

    Parameters
    ----------
    information
        A, shape (f, f), output units squared.
    told
        b, shape (f,).
    recent
        Shape (f, f): the information of the same samples with all of it forgotten alike. It says
        what the last samples determine.
    """

    information: Array
    told: Array
    recent: Array

    @classmethod
    def none(cls, count: int) -> Past:
        """Give that of no samples."""
        return cls(np.zeros((count, count)), np.zeros(count), np.zeros((count, count)))

    def pull(self, x: Array) -> Array:
        """Give half the slope of the squares at x, downhill."""
        return np.asarray(self.told - self.information @ x)

    def cost(self, x: Array, x0: Array) -> float:
        """Give the squares at x less those at x0, to whose neighbourhood the digits belong."""
        step = x - x0
        return float(step @ self.information @ step - 2.0 * self.pull(x0) @ step)

    def with_samples(self, information: Array, pull: Array, x: Array) -> Past:
        """Give it with samples whose squares have this information, and this pull at x."""
        return Past(
            self.information + information,
            self.told + pull + information @ x,
            self.recent + information,
        )

    def turned(self, before: Array, after: Array, floor: float, x: Array) -> Past:
        """Give it as if its samples had been seen from where the estimate is now.

        Derivatives turn as constants move. Sums of squares seen from here and from there would
        tell of directions of which neither does. How derivatives have turned the samples at hand
        show: ``A_after = T' A_before T``, and so for the past.

        Parameters
        ----------
        before, after
            Shape (f, f), information of the same samples from where the estimate was, and is.
        floor
            Information that counts as none, output units squared.
        x
            Shape (f,), the present estimate.
        """
        if not x.size or not self.information.any():
            return self
        base = floor * np.eye(x.size)
        half, back = _roots(before + base)
        turn = back @ _roots(half @ (after + base) @ half)[0] @ back
        information = turn.T @ self.information @ turn
        recent = turn.T @ self.recent @ turn
        pull = turn.T @ self.pull(x)
        return Past(
            0.5 * (information + information.T), pull + information @ x, 0.5 * (recent + recent.T)
        )

    def faded(self, lost: float, arriving: Array, floor: float, x: Array) -> Past:
        """Give it with a share forgotten, in directions of which samples tell anew.

        Along each direction at most ten times as much is forgotten as comes in, so what is not
        driven any more is kept, and the estimate with it.

        Parameters
        ----------
        lost
            Share that is forgotten, 0 to 1.
        arriving
            Shape (f, f), information of the samples that come in.
        floor
            Information that counts as none, output units squared.
        x
            Shape (f,), the present estimate, about which the quadratic is kept in shape.
        """
        if lost <= 0.0 or not x.size:
            return self
        base = self.information + floor * np.eye(x.size)
        try:
            gain, directions = eigh(arriving, base)
        except (np.linalg.LinAlgError, ValueError):
            kept = 1.0 - lost
            information, pull = kept * self.information, kept * self.pull(x)
            return Past(information, pull + information @ x, kept * self.recent)
        kept = 1.0 - np.minimum(lost, _FASTER * np.maximum(gain, 0.0))
        back = directions.T @ base
        shrink = (directions * np.sqrt(kept)) @ back
        information = shrink.T @ self.information @ shrink
        information = 0.5 * (information + information.T)
        pull = (back.T * kept) @ (directions.T @ self.pull(x))
        return Past(information, pull + information @ x, (1.0 - lost) * self.recent)


def _roots(matrix: Array) -> tuple[Array, Array]:
    """Give the square root of a symmetric positive matrix, and the inverse of that."""
    values, vectors = np.linalg.eigh(matrix)
    roots = np.sqrt(np.maximum(values, 1e-30 * max(float(values[-1]), 1e-290)))
    return (vectors * roots) @ vectors.T, (vectors / roots) @ vectors.T
