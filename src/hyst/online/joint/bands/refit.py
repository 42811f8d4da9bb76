"""Least squares over folded samples, among models that have an inverse: Levenberg, Marquardt."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.online.joint.bands.prediction import predicted
from hyst.online.joint.bands.samples import FoldedSamples
from hyst.online.joint.parts import Parts

Array = NDArray[np.float64]

_STEPS, _FEW_STEPS = 60, 6
_LEAST_GAIN = 1e-3


@dataclass(frozen=True, eq=False)
class Problem:
    """What is fitted to what.

    Parameters
    ----------
    parts
        The model.
    samples
        Folded.
    noise
        Variance of one output, which makes squares to a chi-square.
    limit
        Shape (m,), variances of the start; 0 holds a parameter.
    bounds
        Least and most cumulative weight, most radius.
    """

    parts: Parts
    samples: FoldedSamples
    noise: float
    limit: Array
    bounds: tuple[float, float, float]

    @property
    def free(self) -> NDArray[np.bool_]:
        """What is estimated, shape (m,)."""
        return np.asarray(self.limit > 0.0)

    def residual(self, theta: Array) -> tuple[Array, Array]:
        """Give errors over their deviation, shape (R,), and their slopes, shape (m, R)."""
        y, jacobian = predicted(self.parts, theta, self.samples.way)
        weight = np.sqrt(self.samples.count / self.noise)
        return weight * (self.samples.y - y), weight * jacobian

    def admissible(self, theta: Array, fixed: int | None = None) -> Array:
        """Give the nearest parameters, one by one, of a model that has an inverse.

        Parameters
        ----------
        theta
            Shape (m,).
        fixed
            A parameter that stays as it is.

        Returns
        -------
        numpy.ndarray
            Shape (m,).
        """
        n = self.parts.pi.p.size
        least, most, most_radius = self.bounds
        found = theta.copy()
        sums = np.cumsum(theta[: n + 1])
        if sums.size and (sums.min() < least or sums.max() > most):
            found[: n + 1] = np.diff(np.clip(sums, least, most), prepend=0.0)
        radii = np.clip(theta[n + 1 : 2 * n + 1], 0.0, most_radius)
        if fixed is None:
            order = np.argsort(radii, kind="stable")
            found[n + 1 : 2 * n + 1] = radii[order]
            if (np.diff(order) < 0).any() and self.free[1 : 2 * n + 1].all():
                found[1 : n + 1] = found[1 : n + 1][order]
        else:
            k = fixed - n - 1
            if 0 <= k < n:
                radii[k] = theta[fixed]
                radii[:k] = np.minimum(radii[:k], radii[k])
                radii[k + 1 :] = np.maximum(radii[k + 1 :], radii[k])
            found[n + 1 : 2 * n + 1] = np.maximum.accumulate(radii)
        if fixed is not None:
            found[fixed] = theta[fixed]
        return found


@dataclass(frozen=True, eq=False)
class Minimum:
    """Where least squares end.

    Parameters
    ----------
    theta
        Shape (m,).
    chi_square
        Sum of squared errors over their variances.
    information
        Shape (m, m), inverse of the covariance of all that the data determine.
    """

    theta: Array
    chi_square: float
    information: Array


def minimum_from(
    problem: Problem,
    theta: Array,
    fixed: int | None = None,
    enough: float = -np.inf,
    hopeless: float = np.inf,
) -> Minimum:
    """Go down from ``theta``, which the model must admit.

    Parameters
    ----------
    problem
        What is fitted.
    theta
        Shape (m,).
    fixed
        A parameter that is held, as profiles need it.
    enough
        A chi-square below which it need not go on.
    hopeless
        A chi-square above which it gives up after a few steps.

    Returns
    -------
    Minimum
    """
    free = problem.free.copy()
    if fixed is not None:
        free[fixed] = False
    theta = problem.admissible(theta, fixed)
    error, jacobian = problem.residual(theta)
    square, damping = float(error @ error), 1e-4
    for taken in range(_STEPS):
        own = jacobian[free]
        information, slope = own @ own.T, own @ error
        scale = np.diag(information) + 1e-12 * (1.0 + float(np.diag(information).max(initial=0.0)))
        gained = 0.0
        while damping < 1e8:
            step = np.zeros_like(theta)
            step[free] = np.linalg.solve(information + np.diag(damping * scale), slope)
            ahead = problem.admissible(theta + step, fixed)
            error_ahead, jacobian_ahead = problem.residual(ahead)
            square_ahead = float(error_ahead @ error_ahead)
            if square_ahead < square:
                gained = square - square_ahead
                theta, error, jacobian, square = ahead, error_ahead, jacobian_ahead, square_ahead
                damping = max(damping / 10.0, 1e-9)
                break
            damping *= 5.0
        is_hopeless = taken >= _FEW_STEPS and square > hopeless
        if gained < _LEAST_GAIN or square <= enough or is_hopeless:
            break
    return Minimum(theta, square, jacobian @ jacobian.T)
