"""Free parameters of the rate-dependent family and the operator they make."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.models import RateDependentPrandtlIshlinskii
from hyst.operators import Affine, Composition

Array = NDArray[np.float64]

EVEN, FREE, GIVEN = "even", "free", "given"
SPACINGS = (EVEN, FREE)

SMALLEST_SLOPE = 1e-3
"""Least p0 as a share of the mean slope of the records: it bounds the gain of the inverse."""


@dataclass(frozen=True, eq=False)
class Layout:
    """theta = (p0, p_1 .. p_n, spacing or radii or nothing, beta, offset).

    Parameters
    ----------
    plays
        Number of plays n.
    spacing
        ``even``: r_i = zeta i; ``free``: every radius; ``given``: none of them.
    radii
        Shape (n,), the radii if they are given.
    sign
        +1, or -1 where the output falls as the input rises.
    dt
        Sample time, seconds.
    largest_radius, mean_slope
        Of the records.
    has_rate
        Whether beta is free; 0 otherwise.
    """

    plays: int
    spacing: str
    radii: Array
    sign: float
    dt: float
    largest_radius: float
    mean_slope: float
    has_rate: bool

    @property
    def radius_count(self) -> int:
        """How many parameters say where the radii are."""
        return {EVEN: min(self.plays, 1), FREE: self.plays, GIVEN: 0}[self.spacing]

    @property
    def size(self) -> int:
        """Number of free parameters."""
        return self.plays + self.radius_count + 2 + int(self.has_rate)

    @property
    def _radius_matrix(self) -> Array:
        if self.spacing == EVEN:
            return np.arange(1.0, self.plays + 1.0)[:, None][:, : self.radius_count]
        return np.eye(self.plays)[:, : self.radius_count]

    @property
    def transform(self) -> Array:
        """Constants of the operator by theta, shape (2 n + 4, n + radius_count + 3)."""
        n, m = self.plays, self.radius_count
        matrix = np.zeros((2 * n + 4, n + m + 3))
        matrix[: n + 1, : n + 1] = np.eye(n + 1)
        matrix[n + 1 : 2 * n + 1, n + 1 : n + 1 + m] = self._radius_matrix
        matrix[2 * n + 1, n + m + 1] = 1.0
        matrix[-1, -1] = 1.0
        return matrix

    @property
    def lower(self) -> Array:
        """Lower bounds of theta."""
        n, m = self.plays, self.radius_count
        bounds = np.zeros(n + m + 3)
        bounds[0] = SMALLEST_SLOPE * self.mean_slope
        bounds[n + 1 : n + 1 + m] = 1e-3 * self.largest_radius
        bounds[-1] = -np.inf
        return bounds

    @property
    def upper(self) -> Array:
        """Upper bounds of theta."""
        n, m = self.plays, self.radius_count
        bounds = np.full(n + m + 3, np.inf)
        largest = self.largest_radius / n if self.spacing == EVEN and n else self.largest_radius
        bounds[n + 1 : n + 1 + m] = largest
        bounds[n + m + 1] = np.inf if self.has_rate else 0.0
        return bounds

    def r(self, theta: Array) -> Array:
        """Give the radii."""
        if self.spacing == GIVEN:
            return self.radii
        n, m = self.plays, self.radius_count
        return np.asarray(self._radius_matrix @ theta[n + 1 : n + 1 + m])

    def theta(self, weights: Array, radii: Array, beta: float, offset: float) -> Array:
        """Give theta for constants.

        Parameters
        ----------
        weights
            p0 .. p_n.
        radii
            Shape (n,); the first alone counts if they are even, none if they are given.
        beta, offset
            The others.

        Returns
        -------
        numpy.ndarray
        """
        return np.concatenate([weights, radii[: self.radius_count], [beta, offset]])

    def canonical(self, theta: Array) -> Array:
        """Sort the plays by radius, each with its weight: their order means nothing."""
        if self.spacing != FREE:
            return theta
        n = self.plays
        order = np.argsort(theta[n + 1 : 2 * n + 1], kind="stable")
        result = theta.copy()
        result[1 : n + 1] = theta[1 : n + 1][order]
        result[n + 1 : 2 * n + 1] = theta[n + 1 : 2 * n + 1][order]
        return result

    def operator(self, theta: Array) -> Composition:
        """Give the operator for sorted theta: plays, then sign and offset."""
        n = self.plays
        plays = RateDependentPrandtlIshlinskii(
            theta[1 : n + 1], self.r(theta), max(float(theta[-2]), 0.0), self.dt, float(theta[0])
        )
        return Composition((plays, Affine(self.sign, float(theta[-1]))))
