"""A stage of linear dynamics whose every constant is free, by as many numbers as there are.

n^2 + 2 n + 1 constants make 2 n + 1 numbers: all systems of the order are reached, and each by one
vector, as ``A = A0 + B k'``, ``C = c'`` and D move and B stays. The constants are an affine
function of k, c and D, which is what a parametrization is. k and c are counted in coordinates in
which white input makes states that are white and of one size, for the fit to be well-conditioned in
any realization the user gave; the realization stays the user's, a companion form a companion form.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.models import LinearDynamics

Array = NDArray[np.float64]

UNSEEN = 1e-9
"""Share of B in a mode, from which the input moves it."""

AT_REST = 1e-6
"""Gain at rest, over the largest one, from which the gain at rest is what is held."""

_DOUBLINGS = 40  # samples that count: 10^12
_TOO_LARGE = 1e12
_LEAST = 1e-12  # singular value of the scaled root of their covariance, over the states' number


@dataclass(frozen=True, eq=False)
class FreeDynamics:
    """The free numbers of one stage of linear dynamics and where they stand.

    Parameters
    ----------
    name
        Of the stage, as in the names of its constants; empty for a model of this stage alone.
    base
        Where the fit starts; stable.
    constant
        Place of its first constant among those of the model.
    first
        Place of its first number in theta.
    feedthrough
        Whether D is free; it stays 0 otherwise.
    basis
        Shape (n, n): k and C of the realization by the numbers of the fit.
    """

    name: str
    base: LinearDynamics
    constant: int
    first: int
    feedthrough: bool
    basis: Array

    @classmethod
    def of(
        cls, name: str, base: LinearDynamics, constant: int, first: int, feedthrough: bool
    ) -> Self:
        """Choose the coordinates.

        Parameters
        ----------
        name, base, constant, first, feedthrough
            As of the class.

        Raises
        ------
        InputError
            If the dynamics are not stable, or the input does not move all their states.
        """
        what = name or "the model"
        if not base.is_stable():
            raise InputError(
                f"{what} has the pole {base.poles()[0]:.6g}, not inside the unit circle; start the "
                "fit from stable dynamics, or name the entries that may move"
            )
        _require_reachable(what, base)
        return cls(name, base, constant, first, feedthrough, _basis(base))

    @property
    def size(self) -> int:
        """How many numbers are free."""
        return 2 * self.base.order + int(self.feedthrough)

    @property
    def constants(self) -> slice:
        """Which constants of the model are its own."""
        n = self.base.order
        return slice(self.constant, self.constant + (n + 2) * n + 1)

    @property
    def own(self) -> slice:
        """Which entries of theta are its own."""
        return slice(self.first, self.first + self.size)

    def start(self) -> Array:
        """Give the numbers of the base."""
        n = self.base.order
        c = np.linalg.solve(self.basis, self.base.C) if n else np.zeros(0)
        return np.concatenate([np.zeros(n), c, np.full(int(self.feedthrough), self.base.D)])

    def transform(self) -> Array:
        """Give the derivative of its constants by its numbers."""
        n = self.base.order
        result = np.zeros((n * n + 2 * n + 1, self.size))
        result[: n * n, :n] = np.kron(self.base.B[:, None], self.basis)
        result[n * n + n : n * n + 2 * n, n : 2 * n] = self.basis
        result[n * n + 2 * n :, 2 * n :] = 1.0
        return result

    def fixed(self) -> Array:
        """Give its constants where all its numbers are 0."""
        n = self.base.order
        return np.concatenate([self.base.A.ravel(), self.base.B, np.zeros(n + 1)])

    def dynamics(self, theta: Array) -> LinearDynamics:
        """Give the stage of a theta of the model."""
        n, base = self.base.order, self.base
        k, c, d = np.split(theta[self.own], [n, 2 * n])
        A = base.A + np.outer(base.B, self.basis @ k)
        D = float(d[0]) if self.feedthrough else 0.0
        return LinearDynamics(A, base.B, self.basis @ c, D, base.dt, base.delay, base.x0)

    def is_stable(self, theta: Array) -> bool:
        """Tell whether the stage of a theta of the model is stable."""
        n = self.base.order
        k = self.basis @ theta[self.first : self.first + n]
        A = self.base.A + np.outer(self.base.B, k)
        return bool(np.abs(np.linalg.eigvals(A)).max(initial=0.0) < 1.0)

    def by_own(self, rows: Array) -> Array:
        """Give derivatives by the numbers of the fit from those by k, C and D of the realization.

        Parameters
        ----------
        rows
            Shape (q, 2 n), or one column more for D.
        """
        n = self.base.order
        return np.concatenate(
            [rows[:, :n] @ self.basis, rows[:, n : 2 * n] @ self.basis, rows[:, 2 * n :]], axis=1
        )

    def gauge(self, theta: Array) -> tuple[float, Array]:
        """Give by how much its size differs from that of the base, and the derivative by theta.

        The size is the gain at rest; where that is nothing, the part of C and D along the base's.
        With ``(I - A0 - B k')^-1 B = x / (1 - k' x)``, ``x = (I - A0)^-1 B``, a gain g at rest is
        ``c' x + (D - g) (1 - k' x) = 0``, which without D is a plane: a fit goes along it with
        steps as long as it likes.

        Parameters
        ----------
        theta
            Of the model.
        """
        row = np.zeros(theta.size)
        if not has_gain_at_rest(self.base):
            along = self.start()
            along[: self.base.order] = 0.0
            row[self.own] = along / float(along @ along)
            return float(row @ theta) - 1.0, row
        n, size = self.base.order, self.base.dc_gain()
        x = np.linalg.solve(np.eye(n) - self.base.A, self.base.B) if n else np.zeros(0)
        k, c, d = np.split(theta[self.own], [n, 2 * n])
        x = x @ self.basis
        rest, D = 1.0 - float(k @ x), float(d.sum())
        row[self.own] = np.concatenate([(size - D) * x, x, np.full(d.size, rest)]) / size
        return (float(c @ x) + (D - size) * rest) / size, row

    def gain(self, theta: Array) -> tuple[float, Array]:
        """Give the gain at rest and its derivative by the stage's own numbers."""
        now, n = self.dynamics(theta), self.base.order
        x = np.linalg.solve(np.eye(n) - now.A, now.B) if n else np.zeros(0)
        states = float(now.C @ x) if n else 0.0
        row = np.concatenate([states * x, x, np.ones(int(self.feedthrough))])
        return states + now.D, self.by_own(row[None, :])[0]


def has_gain_at_rest(dynamics: LinearDynamics) -> bool:
    """Tell whether the gain at rest says how large dynamics are; of a high-pass it does not.

    Parameters
    ----------
    dynamics
        Stable.
    """
    frequency = np.linspace(0.0, 0.5 / dynamics.dt, 257)
    largest = float(np.abs(dynamics.frequency_response(frequency)).max())
    return abs(dynamics.dc_gain()) > AT_REST * largest


def _require_reachable(what: str, base: LinearDynamics) -> None:
    if base.order == 0:
        return
    poles, left = np.linalg.eig(base.A.T)
    shares = np.abs(base.B @ left) / max(float(np.linalg.norm(base.B)), np.finfo(float).tiny)
    if shares.min() < UNSEEN:
        pole = poles[int(shares.argmin())]
        raise InputError(
            f"{what} has the pole {pole:.6g}, which its input does not move, so no fit could "
            "either; give dynamics of a lower order"
        )


def _basis(base: LinearDynamics) -> Array:
    """Give T'^-1, where T T' is the covariance of the states for white input."""
    n = base.order
    if n == 0:
        return np.zeros((0, 0))
    # By doubling a root of the sum of squares: it stays one however near the circle a pole lies.
    root, power = base.B[:, None], base.A
    for _ in range(_DOUBLINGS):
        if float(np.abs(power).max()) > _TOO_LARGE:  # rounding has moved a pole out of the circle
            break
        both = np.concatenate([root, power @ root], axis=1)
        root, power = np.asarray(np.linalg.qr(both.T, mode="r")).T, power @ power
    size = np.maximum(np.linalg.norm(root, axis=1), np.sqrt(np.finfo(float).tiny))
    vectors, values, _ = np.linalg.svd(root / size[:, None])
    values = np.pad(values, (0, n - values.size))
    return np.asarray(vectors / np.maximum(values, _LEAST * n) / size[:, None])
