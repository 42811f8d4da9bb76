"""The numbers of a stated model that an identification has to find, as directions of its constants.

Dynamics of order n have ``2 n`` numbers, or ``2 n + 1`` with a feedthrough, whatever their
realization: ``A + B k'``, C and D move. Where something else can take up their gain, it is held.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.models import LinearDynamics
from hyst.operators import Composition, Operator
from hyst.operators.composition import leaves_of

Array = NDArray[np.float64]

_ONE_POLE = 1e6  # condition of the eigenvectors of balanced dynamics


@dataclass(frozen=True, eq=False)
class FreeNumbers:
    """A model in well-conditioned coordinates and the directions in which it may move.

    Parameters
    ----------
    leaves
        The model's parts in the order of the signal.
    directions
        Shape (constants, m).
    held
        Shape (g, m): what must not move, the gains of dynamics.
    first
        Column of ``directions`` with which each part begins.
    """

    leaves: tuple[Operator, ...]
    directions: Array
    held: Array
    first: tuple[int, ...]

    @property
    def model(self) -> Operator:
        """The parts one after the other."""
        return self.leaves[0] if len(self.leaves) == 1 else Composition(self.leaves)

    @property
    def count_of_dynamics(self) -> int:
        """How many directions belong to dynamics, with those that are held."""
        return sum(
            2 * each.order + int(each.D != 0.0)
            for each in self.leaves
            if isinstance(each, LinearDynamics)
        )

    @property
    def dynamics(self) -> list[tuple[int, LinearDynamics]]:
        """Those with states, with their first column."""
        return [
            (first, each)
            for first, each in zip(self.first, self.leaves, strict=False)
            if isinstance(each, LinearDynamics) and each.order
        ]


def free_numbers(model: Operator) -> FreeNumbers:
    """Give what an identification of the model has to find.

    Parameters
    ----------
    model
        Dynamics anywhere in it; all else moves with all its constants.

    Raises
    ------
    InputError
        If dynamics are not stable, or two of their poles are so near one another that they have no
        frequency and damping of their own.
    """
    leaves = tuple(
        _balanced(each) if isinstance(each, LinearDynamics) else each for each in leaves_of(model)
    )
    for each in leaves:
        if isinstance(each, LinearDynamics) and each.order:
            _require_usable(each)
    blocks = [
        _directions_of(each) if isinstance(each, LinearDynamics) else np.eye(len(each.parameters()))
        for each in leaves
    ]
    first = np.cumsum([0, *(each.shape[1] for each in blocks)])
    rows = []
    scaled_by_others = any(
        not isinstance(each, LinearDynamics) and len(each.parameters()) for each in leaves
    )
    for place, each in zip(first, leaves, strict=False):
        if isinstance(each, LinearDynamics) and scaled_by_others:
            row = np.zeros(first[-1])
            gain = _gain_by_directions(each)
            row[place : place + gain.size] = gain
            rows.append(row)
    held = np.array(rows).reshape(len(rows), int(first[-1]))
    return FreeNumbers(
        leaves, scipy.linalg.block_diag(*blocks), held, tuple(int(each) for each in first[:-1])
    )


def poles_by_directions(dynamics: LinearDynamics) -> tuple[NDArray[np.complex128], Array]:
    """Give continuous poles ``log(z) / dt`` and their derivatives by the dynamics' directions.

    Parameters
    ----------
    dynamics
        Of order n, with different poles.

    Returns
    -------
    numpy.ndarray
        Shape (n,), rad/s.
    numpy.ndarray
        Shape (n, n), by k; C and D move no pole.
    """
    z, right = np.linalg.eig(dynamics.A)
    left_b = np.linalg.solve(right, dynamics.B.astype(complex))
    by_k = left_b[:, None] * right.T
    z = z.astype(np.complex128)
    z[z == 0.0] = np.finfo(np.float64).tiny
    return np.log(z) / dynamics.dt, by_k / (z * dynamics.dt)[:, None]


def frequency_and_damping(pole: complex, slope: Array) -> tuple[float, float, Array]:
    """Give frequency in Hz and damping ratio of a continuous pole, and their derivatives.

    Parameters
    ----------
    pole
        rad/s.
    slope
        Shape (n,), its derivative.

    Returns
    -------
    frequency, damping : float
    numpy.ndarray
        Shape (2, n).
    """
    size = abs(pole)
    damping = -pole.real / size
    by_size = np.real(np.conj(pole) * slope) / size
    by_damping = -np.real(slope) / size - damping * by_size / size
    return size / (2.0 * np.pi), damping, np.array([by_size / (2.0 * np.pi), by_damping])


def _require_usable(dynamics: LinearDynamics) -> None:
    poles, vectors = np.linalg.eig(dynamics.A)
    if not dynamics.is_stable():
        raise InputError(
            f"the stated dynamics are not stable: a pole is at |z| = {np.abs(poles).max():.6g}; "
            "state stable ones, an integrator without its pole at 1"
        )
    if np.linalg.cond(vectors) > _ONE_POLE:
        raise InputError(
            "two poles of the stated dynamics are one, so neither has a frequency of its own; "
            "state them one per cent apart"
        )


def _directions_of(dynamics: LinearDynamics) -> Array:
    n, feedthrough = dynamics.order, int(dynamics.D != 0.0)
    result = np.zeros((n * n + 2 * n + 1, 2 * n + feedthrough))
    result[: n * n, :n] = np.kron(dynamics.B[:, None], np.eye(n))
    result[n * n + n : n * n + 2 * n, n : 2 * n] = np.eye(n)
    result[n * n + 2 * n :, 2 * n :] = 1.0
    return result


def _gain_by_directions(dynamics: LinearDynamics) -> Array:
    n = dynamics.order
    x = np.linalg.solve(np.eye(n) - dynamics.A, dynamics.B)
    feedthrough = [1.0] if dynamics.D != 0.0 else []
    return np.concatenate([float(dynamics.C @ x) * x, x, feedthrough])


def _balanced(dynamics: LinearDynamics) -> LinearDynamics:
    """Give the same dynamics in coordinates whose directions differ, if there are such."""
    if dynamics.order == 0 or not dynamics.is_stable():
        return dynamics
    A, B, C = dynamics.A, dynamics.B[:, None], dynamics.C[None, :]
    try:
        reached = scipy.linalg.cholesky(
            scipy.linalg.solve_discrete_lyapunov(A, B @ B.T), lower=True
        )
        seen = scipy.linalg.solve_discrete_lyapunov(A.T, C.T @ C)
        values, vectors = np.linalg.eigh(reached.T @ seen @ reached)
    except np.linalg.LinAlgError:
        return dynamics
    if values[0] <= 1e-14 * values[-1]:
        return dynamics
    change = reached @ vectors / values**0.25
    back = np.linalg.inv(change)
    return LinearDynamics(
        back @ A @ change,
        back @ dynamics.B,
        dynamics.C @ change,
        dynamics.D,
        dynamics.dt,
        dynamics.delay,
        back @ dynamics.x0,
    )
