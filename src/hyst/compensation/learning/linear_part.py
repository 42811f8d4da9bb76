"""What a plant does behind the model's inverse, as far as that is linear."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


_TURNING = 1e-9


@final
@dataclass(frozen=True, eq=False)
class LinearPart:
    """A rational transfer function from what the model is told to give to what is measured.

        G(z) = z^-delay (b[0] + b[1] z^-1 + ...) / (1 + a[0] z^-1 + ...)

    Parameters
    ----------
    b, a
        Coefficients, shape (m,) and (n,).
    delay
        Samples.
    covariance
        Of a and then b, shape (n + m, n + m); zeros where they are assumed.

    Examples
    --------
    >>> LinearPart.one().at([0.0, 0.1])
    array([1.+0.j, 1.+0.j])
    """

    b: Array
    a: Array
    delay: int
    covariance: Array

    @classmethod
    def one(cls) -> LinearPart:
        """Give what a plant does that the model knows."""
        return cls(np.ones(1), np.zeros(0), 0, np.zeros((1, 1)))

    @property
    def order(self) -> int:
        """Number of poles."""
        return self.a.size

    def scaled(self, gain: float) -> LinearPart:
        """Give the same dynamics with another gain."""
        by = np.concatenate([np.ones(self.a.size), np.full(self.b.size, gain)])
        return LinearPart(self.b * gain, self.a, self.delay, self.covariance * np.outer(by, by))

    def at(self, frequency: ArrayLike) -> Complex:
        """Give the response at frequencies in cycles a sample."""
        z = np.exp(-2j * np.pi * np.asarray(frequency, dtype=np.float64))
        above = np.polynomial.polynomial.polyval(z, self.b)
        below = np.polynomial.polynomial.polyval(z, np.concatenate([[1.0], self.a]))
        return np.asarray(z**self.delay * above / below)

    def doubt(self, frequency: ArrayLike) -> Array:
        """Give the standard error of the response over its size, in cycles a sample."""
        z = np.exp(-2j * np.pi * np.asarray(frequency, dtype=np.float64))
        n, m = self.a.size, self.b.size
        above = np.polynomial.polynomial.polyval(z, self.b)
        below = np.polynomial.polynomial.polyval(z, np.concatenate([[1.0], self.a]))
        powers = z[:, None] ** np.arange(max(n + 1, m))
        relative = np.concatenate(
            [-powers[:, 1 : n + 1] / below[:, None], powers[:, :m] / above[:, None]], axis=1
        )
        variance = np.einsum("ki,ij,kj->k", relative, self.covariance, relative.conj()).real
        return np.asarray(np.sqrt(np.maximum(variance, 0.0)))

    def modes(self) -> Array:
        """Give the frequencies of pairs of poles, cycles a sample."""
        poles = np.roots(np.concatenate([[1.0], self.a]))
        return np.asarray(np.abs(np.angle(poles[poles.imag > _TURNING])) / (2.0 * np.pi))

    def settling(self, share: float = 1e-3) -> int:
        """Give after how many samples less than a share of a pulse rings on."""
        if not self.a.size:
            return self.delay + self.b.size
        slowest = float(np.abs(np.roots(np.concatenate([[1.0], self.a]))).max())
        if slowest < 1e-6:
            return self.delay + self.b.size
        rings = np.log(share) / np.log(min(slowest, 1.0 - 1e-9))
        return self.delay + self.b.size + int(min(rings, 1e9))

    def to_dict(self) -> dict[str, Any]:
        """Give plain numbers."""
        return {
            "b": self.b.tolist(),
            "a": self.a.tolist(),
            "delay": self.delay,
            "covariance": self.covariance.tolist(),
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> LinearPart:
        """Rebuild it from ``to_dict()``.

        Parameters
        ----------
        data
            What it gave.
        """
        b, a = np.array(data["b"], dtype=float), np.array(data["a"], dtype=float)
        size = b.size + a.size
        covariance = np.array(data["covariance"], dtype=float).reshape(size, size)
        return cls(b, a, int(data["delay"]), covariance)
