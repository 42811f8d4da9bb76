"""The population of devices: what is known of one before and after its record."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
import scipy.special
from numpy.typing import NDArray

from hyst.fleet.shared_shape.device_equations import Equations
from hyst.fleet.shared_shape.noise import Noise

Array = NDArray[np.float64]


SMALLEST = 1e-10
"""Of the largest eigenvalue of a covariance: along smaller ones devices do not differ."""


@dataclass(frozen=True, eq=False)
class Population:
    """Devices of a fleet: ``z ~ N(0, covariance)``.

    Parameters
    ----------
    covariance
        Shape (q, q): how devices scatter around the mean, and for one that took no part in the
        estimate how unsure that mean is as well.
    noise
        Of its devices.
    stretch
        By which distances of its own devices are larger than normal numbers say, at least 1.
    """

    covariance: Array
    noise: Noise
    stretch: float = 1.0

    @functools.cached_property
    def precision(self) -> Array:
        """The pseudoinverse of the covariance, shape (q, q)."""
        return np.asarray(np.linalg.pinv(self.covariance, rcond=SMALLEST, hermitian=True))

    def posterior(self, equations: Equations) -> tuple[Array, Array]:
        """Give what is known of devices with their records.

        Parameters
        ----------
        equations
            Of the devices.

        Returns
        -------
        mean : numpy.ndarray
            Shape (devices, q), the likeliest z.
        covariance : numpy.ndarray
            Shape (devices, q, q).

        Notes
        -----
        Best linear unbiased prediction: G. K. Robinson, Stat. Sci. 6 (1991), 15-32.
        """
        size = np.sqrt(self.noise.of(equations))
        rows, along = equations.rows / size[:, None, None], equations.along / size[:, None]
        through = rows @ self.covariance
        total = np.eye(rows.shape[1]) + through @ rows.transpose(0, 2, 1)
        gain = np.linalg.solve(total, through).transpose(0, 2, 1)
        mean = np.einsum("dij,dj->di", gain, along)
        return mean, self.covariance - gain @ through

    def squared_distances(self, equations: Equations) -> Array:
        """Give how far records are from what the population lets expect, shape (devices,).

        Of a device of the population each is a sum of ``rank`` squared normal numbers, but for the
        estimate of its noise.

        Parameters
        ----------
        equations
            Of the devices.
        """
        size = np.sqrt(self.noise.of(equations))
        rows, along = equations.rows / size[:, None, None], equations.along / size[:, None]
        spread = rows @ self.covariance @ rows.transpose(0, 2, 1)
        total = np.eye(rows.shape[1]) + spread
        squares = np.einsum("di,di->d", along, np.linalg.solve(total, along[:, :, None])[:, :, 0])
        return np.asarray(squares / self.stretch)

    def chance(self, equations: Equations) -> Array:
        """Give the probability that a device of the population lies as far, shape (devices,).

        Parameters
        ----------
        equations
            Of the devices.
        """
        rank = np.maximum(equations.rank, 1).astype(float)
        freedom = self.noise.freedom + equations.freedom / self.noise.correlation
        ratio = self.squared_distances(equations) / rank
        return np.asarray(scipy.special.fdtrc(rank, freedom, ratio))

    def excess(self, equations: Equations) -> Array:
        """Give squared distances over their middle value in the population, shape (devices,)."""
        rank = np.maximum(equations.rank, 1).astype(float)
        freedom = self.noise.freedom + equations.freedom / self.noise.correlation
        middle = rank * scipy.special.fdtri(rank, np.minimum(freedom, 1e6), 0.5)
        return np.asarray(self.squared_distances(equations) / middle)
