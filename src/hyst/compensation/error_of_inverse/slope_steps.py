"""The cumulative weights of a bank of plays, as a step function of the threshold."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.models import PrandtlIshlinskii

Array = NDArray[np.float64]


@final
@dataclass(frozen=True, eq=False)
class SlopeSteps:
    """Step function ``phi(s) = p0 + sum of the p_i with r_i <= s`` (S1 eqs. 3, 11, 12).

    It is the slope of the loading curve, and the bank of plays is
    ``y = - integral of (d F_s[u] / ds) phi(s) ds`` from 0 to the largest ``|u|`` (S1 eq. 13), since
    from rest a play of a threshold beyond that has never moved.

    Parameters
    ----------
    starts
        Shape (k,), where the pieces begin, strictly ascending from 0.
    levels
        Shape (k,), phi on each piece; the last goes on for ever.

    Examples
    --------
    >>> steps = SlopeSteps.of(PrandtlIshlinskii([0.5, 0.25], [1.0, 2.0], p0=1.0))
    >>> steps.levels, steps.largest_output(3.0)
    (array([1.  , 1.5 , 1.75]), 4.25)
    """

    starts: Array
    levels: Array

    @classmethod
    def of(cls, pi: PrandtlIshlinskii) -> SlopeSteps:
        """Give the step function of a model; a play of threshold 0 is the input itself.

        Parameters
        ----------
        pi
            Any Prandtl-Ishlinskii model.

        Returns
        -------
        SlopeSteps
        """
        thresholds = np.append(0.0, pi.r)
        starts, last = np.unique(thresholds[::-1], return_index=True)
        sums = pi.p0 + np.append(0.0, np.cumsum(pi.p))
        return cls(starts, sums[::-1][last])

    def __call__(self, s: Array) -> Array:
        """Give phi at thresholds >= 0, continuous from the right."""
        return np.asarray(self.levels[np.searchsorted(self.starts, s, side="right") - 1])

    def pieces(self, reach: float) -> tuple[Array, Array]:
        """Give the pieces below a threshold.

        Parameters
        ----------
        reach
            Largest amplitude, positive, input units.

        Returns
        -------
        edges : numpy.ndarray
            Shape (m + 1,), from 0 to ``reach``.
        levels : numpy.ndarray
            Shape (m,).
        """
        below = self.starts < reach
        return np.append(self.starts[below], reach), self.levels[below]

    def integral(self, reach: float) -> tuple[Array, Array]:
        """Give ``integral of |phi|`` from 0 to each edge: the largest output of that amplitude.

        Parameters
        ----------
        reach
            Largest amplitude, positive, input units.

        Returns
        -------
        edges, values : numpy.ndarray
            Shape (m + 1,) each.
        """
        edges, levels = self.pieces(reach)
        return edges, np.append(0.0, np.cumsum(np.abs(levels) * np.diff(edges)))

    def largest_output(self, reach: float) -> float:
        """Give the largest ``|y|`` of any input with ``|u| <= reach`` from rest.

        Parameters
        ----------
        reach
            Largest amplitude, positive, input units.

        Returns
        -------
        float
        """
        return float(self.integral(reach)[1][-1])

    def minus(self, other: SlopeSteps) -> SlopeSteps:
        """Give the step function of the difference of two banks of plays.

        Parameters
        ----------
        other
            What is taken away.

        Returns
        -------
        SlopeSteps
        """
        starts = np.union1d(self.starts, other.starts)
        return SlopeSteps(starts, self(starts) - other(starts))

    def worst_input(self, reach: float) -> Array:
        """Give the turning points of the input whose output from rest ends at ``integral |phi|``.

        Its memory ``s -> F_s`` has slope -1 where phi is positive and +1 where it is negative, so
        every threshold adds to the output.

        Parameters
        ----------
        reach
            Largest amplitude, positive, input units.

        Returns
        -------
        numpy.ndarray
            Shape (k,), all within ``-reach .. reach``.
        """
        edges, levels = self.pieces(reach)
        signs = np.sign(levels)
        if not signs.any():
            return np.array([reach])
        counts = signs != 0.0
        starts, signs = edges[:-1][counts], signs[counts]
        # From the outermost threshold inwards, a turn at each change of sign.
        turns = np.flatnonzero(np.diff(signs))[::-1]
        points = [signs[-1] * reach]
        for k in turns:
            points.append(points[-1] - 2.0 * signs[k + 1] * starts[k + 1])
        return np.array(points)
