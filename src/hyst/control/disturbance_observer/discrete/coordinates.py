"""States in which a gain keeps its digits.

The same observer can be written in many coordinates. In those of a transfer function with many
poles next to z = 1 the rounding of L may move the poles of the observer; in those in which the
plant's states are reached and seen alike it may not. Which do is seen from the block that results.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.control.disturbance_observer.discrete.problem import SampledObserverProblem
from hyst.control.disturbance_observer.discrete.stacked_gain import (
    SampledFrequencies,
    SampledStackedGain,
)
from hyst.control.linear_system import LinearSystem, balanced
from hyst.errors import SolverError

Array = NDArray[np.float64]

_GOOD, _ENOUGH = 1e-6, 1e-2  # of the largest square of the stacked gain


def held_gain(
    gain: SampledStackedGain, parameters: Array, problem: SampledObserverProblem
) -> tuple[SampledObserverProblem, Array]:
    """Give the gain L for the parameters, and the problem in the coordinates that hold it.

    Parameters
    ----------
    gain
        The stacked gain that was minimized.
    parameters
        Where it is least.
    problem
        With the internal model of the parameters.

    Raises
    ------
    SolverError
        If no coordinates hold the gain.
    """
    best: tuple[float, SampledObserverProblem, Array] | None = None
    for plant in (problem.plant, _evened(problem.plant)):
        if plant is None:
            continue
        sampled = replace(problem.sampled, system=plant)
        tried = replace(problem, plant=plant, sampled=sampled)
        with np.errstate(all="ignore"):
            L = gain.gain_in(plant, parameters)
        error = _error(gain, parameters, tried, L)
        if best is None or error < best[0]:
            best = error, tried, L
        if best[0] < _GOOD:
            break
    if best is None or best[0] > _ENOUGH:
        raise SolverError(
            f"an observer of order {gain.total} with poles so near z = 1 cannot be held in doubles "
            f"at dt = {problem.dt:.4g} s; give a plant of lower order, or sample more slowly"
        )
    return best[1], best[2]


def _error(
    gain: SampledStackedGain, parameters: Array, problem: SampledObserverProblem, L: Array
) -> float:
    """Compare the stacked gain of the observer's matrices with that of the polynomials."""
    if not np.isfinite(L).all():
        return np.inf
    at, observer = gain.grid, problem.observer(L)
    assert isinstance(at, SampledFrequencies)
    if np.abs(observer.poles()).max() >= 1.0:
        return np.inf
    z = (1.0 + 1j * at.w) / (1.0 - 1j * at.w)
    channels = observer.response(z)[:, 0]
    E, N = 1.0 + channels[:, 0], at.plain + at.S0 * channels[:, 1]
    found = at.Wu2 * np.abs(N) ** 2 + at.Wp2 * np.abs(E) ** 2
    expected = gain.values(parameters, at)
    return float(np.abs(found - expected).max() / expected.max())


def _evened(system: LinearSystem) -> LinearSystem | None:
    """Give the system in states that are reached and seen alike; None where that has no digits."""
    plain = balanced(system)
    try:
        reached = _root(scipy.linalg.solve_discrete_lyapunov(plain.A, plain.B @ plain.B.T))
        seen = _root(scipy.linalg.solve_discrete_lyapunov(plain.A.T, plain.C.T @ plain.C))
        left, sizes, right = np.linalg.svd(seen.T @ reached)
    except np.linalg.LinAlgError:
        return None
    if not sizes[-1] > 1e-15 * sizes[0]:
        return None
    out, into = reached @ right.T / np.sqrt(sizes), (left / np.sqrt(sizes)).T @ seen.T
    return LinearSystem(into @ plain.A @ out, into @ plain.B, plain.C @ out, plain.D, plain.dt)


def _root(matrix: Array) -> Array:
    values, vectors = np.linalg.eigh(0.5 * (matrix + matrix.T))
    return np.asarray(vectors * np.sqrt(np.maximum(values, 1e-16 * values.max())))
