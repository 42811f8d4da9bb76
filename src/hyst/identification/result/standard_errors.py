"""How sure the free parameters of a fit are, and which of them the records do not determine.

The normal matrix, its columns scaled to one size, is split into the directions the records
determine and those they do not. The covariance lives in the former; a quantity that the latter
could move by more than its own standard error has none.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.identification.result.covariance import ScoreSums

Array = NDArray[np.float64]

SMALLEST_EIGENVALUE = 1e-11
"""Of the scaled normal matrix: below it, rounding alone decides."""

ROUNDING_OF_DIRECTIONS = 1e-6
"""Share of a quantity in a direction that is nothing but the rounding of both."""

NOT_DISTURBED = 0.3
"""Standard errors by which what is not determined may move a quantity that is."""


@dataclass(frozen=True, eq=False)
class Spread:
    """Covariance of free parameters, and the directions in which they are not determined.

    Parameters
    ----------
    unit
        Shape (m,), sizes that bring the parameters to one scale.
    noise
        Size of the residual, a power of two.
    covariance
        Shape (m, m), of what is determined, in those units: it neither over- nor underflows.
    open_directions
        Shape (m, k): changes of theta the records say nothing about, each as large as the whole
        model.
    """

    unit: Array
    noise: float
    covariance: Array
    open_directions: Array

    def of(self, rows: Array) -> Array:
        """Give the standard errors of linear functions of theta.

        Parameters
        ----------
        rows
            Shape (q, m), the functions.

        Returns
        -------
        numpy.ndarray
            Shape (q,), NaN where a function is not determined.
        """
        errors = self.if_determined(rows)
        errors[self.disturbed(rows).any(axis=1)] = np.nan
        return errors

    def disturbed(self, rows: Array) -> NDArray[np.bool_]:
        """Tell which functions are not determined, and for want of which direction.

        Parameters
        ----------
        rows
            Shape (q, m), linear functions of theta.

        Returns
        -------
        numpy.ndarray
            Shape (q, k): whether a change along each of ``open_directions`` moves the function by
            more than the rest of its standard error.
        """
        parts = np.abs(rows) @ np.abs(self.open_directions)
        moved = np.abs(rows @ self.open_directions)
        moved[moved <= ROUNDING_OF_DIRECTIONS * parts] = 0.0
        return np.asarray(moved > NOT_DISTURBED * self.if_determined(rows)[:, None])

    def if_determined(self, rows: Array) -> Array:
        """Give the standard errors as if the open directions did not exist.

        Parameters
        ----------
        rows
            Shape (q, m), linear functions of theta.
        """
        plain = rows / self.unit
        size = np.abs(plain).max(axis=1, initial=0.0)
        size = np.ldexp(1.0, np.frexp(size)[1])
        plain = plain / size[:, None]
        variance = np.einsum("ij,jk,ik->i", plain, self.covariance, plain)
        return np.asarray(np.sqrt(np.maximum(variance, 0.0)) * self.noise * size)


def spread_of_estimates(
    sums: ScoreSums, theta: Array, gauges: Array | None = None, taken_out: int = 0
) -> Spread:
    """Estimate how sure least squares estimates are.

    Parameters
    ----------
    sums
        Over the samples, of the residual and its derivative by the m parameters that are free to
        move.
    theta
        Shape (m,), the estimates: a direction whose standard error is as large as all of them is
        not determined.
    gauges
        Shape (g, m): rows that a change of theta must not move, for scales that are held because no
        record can determine them; none if left out.
    taken_out
        Directions that were projected out of Jacobian and residual.

    Returns
    -------
    Spread
    """
    unit, within = sums.unit, _within(gauges, sums.unit)
    eigenvalues, vectors = np.linalg.eigh(within.T @ sums.gram @ within)
    vectors = within @ vectors
    shown = np.diag(sums.gram) > 0.0
    size = float(np.abs(theta * np.where(shown, unit, 0.0)).max(initial=0.0)) or 1.0
    known = eigenvalues >= SMALLEST_EIGENVALUE
    inner = np.zeros((theta.size, theta.size))
    while known.any():
        basis = vectors[:, known]
        inner = sums.along(basis).covariance(taken_out=taken_out)
        lost = np.sqrt(np.diag(inner)) * sums.noise > size
        if not lost.any():
            inner = basis @ inner @ basis.T
            break
        known[np.flatnonzero(known)[lost]] = False
        inner = np.zeros((theta.size, theta.size))
    open_ones = vectors[:, ~known]
    return Spread(unit, sums.noise, inner, open_ones * (size / unit)[:, None])


def spread_under_prior(sums: ScoreSums, prior: Array, taken_out: int = 0) -> Spread:
    """Estimate how sure estimates are that a prior holds where the records do not.

    Parameters
    ----------
    sums
        As of ``spread_of_estimates``.
    prior
        Shape (q, m): rows whose square was added to the cost.
    taken_out
        Directions that were projected out of Jacobian and residual.

    Returns
    -------
    Spread
        With no open direction.
    """
    scaled = prior / sums.unit
    size = np.sqrt(np.diag(sums.gram) + np.einsum("ij,ij->j", scaled, scaled))
    size = np.where(size > 0.0, size, 1.0)
    covariance = sums.along(np.diag(1.0 / size)).covariance(scaled / size, taken_out)
    return Spread(size * sums.unit, sums.noise, covariance, np.empty((size.size, 0)))


def _within(gauges: Array | None, unit: Array) -> Array:
    """Give an orthonormal basis of the changes of scaled parameters that keep the gauges."""
    if gauges is None or len(gauges) == 0:
        return np.eye(unit.size)
    rows = gauges / unit
    size = np.linalg.norm(rows, axis=1, keepdims=True)
    rows = rows / np.where(size > 0.0, size, 1.0)
    return np.asarray(scipy.linalg.null_space(rows))
