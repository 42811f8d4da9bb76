"""Step 5, second half: hysteresis and dynamics refined together on the simulated output.

The dynamics keep the well-conditioned coordinates of their realization: ``A = A0 + B0 k'``,
``B = B0``, C and D free. That reaches every system of the order with 2n + 1 numbers, and the
constants are an affine function of them. What data cannot determine, the factor between hysteresis
and dynamics, is held by rows of the residual that the optimum makes zero.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.identification.families.hammerstein.front import Front
from hyst.identification.fit.bounded_least_squares import (
    CONVERGED,
    Problem,
    Solution,
    minimize,
)
from hyst.identification.fit.problem import model_output
from hyst.identification.record_use.used_samples import Data
from hyst.models import LinearDynamics
from hyst.operators import Operator

Array = NDArray[np.float64]

_WARM_UP = 8_000  # samples of each record for the coarse refinement
_BURST = 12
_STALLED = 0.99
_TOLERANCE = 2e-2  # of the residual variance: at most a seventh of a standard error is left
MOST_SAMPLES = 300_000
"""The Jacobian is held in memory; of longer records the beginning is refined on."""


@dataclass(frozen=True, eq=False)
class Joint:
    """Free parameters of hysteresis and dynamics together.

    Parameters
    ----------
    front
        The hysteresis.
    base
        Realization whose coordinates are kept; stable.
    feedthrough
        Whether D is free; it is 0 otherwise.
    """

    front: Front
    base: LinearDynamics
    feedthrough: bool

    @property
    def front_size(self) -> int:
        """Number of free parameters of the hysteresis; theta starts with them."""
        return self.front.parametrization.size

    @property
    def size(self) -> int:
        """Number of all free parameters."""
        return self.front_size + 2 * self.base.order + int(self.feedthrough)

    def start(self) -> Array:
        """Give theta of the first guess."""
        n = self.base.order
        feedthrough = [self.base.D] if self.feedthrough else []
        return np.concatenate([self.front.theta, np.zeros(n), self.base.C, feedthrough])

    def hysteresis(self, theta: Array) -> Operator:
        """Give the hysteresis."""
        return self.front.parametrization.operator(theta[: self.front_size])

    def dynamics(self, theta: Array) -> LinearDynamics:
        """Give the dynamics."""
        base, n = self.base, self.base.order
        k, c, d = np.split(theta[self.front_size :], [n, 2 * n])
        feedback = base.A + np.outer(base.B, k)
        D = float(d[0]) if self.feedthrough else 0.0
        return LinearDynamics(feedback, base.B, c, D, base.dt, base.delay)

    def project(self, jacobian: Array, result: Array) -> None:
        """Turn the jacobian by all constants into that by theta, written into ``result``."""
        n, transform = self.base.order, self.front.parametrization.transform
        constants, first = transform.shape[0], self.front_size
        used = transform.any(axis=1)  # constants that are free: most columns may be left alone
        places = np.flatnonzero(used)
        np.matmul(jacobian[:, places], transform[used], out=result[:, :first])
        by_a = jacobian[:, constants : constants + n * n]
        np.matmul(by_a, np.kron(self.base.B[:, None], np.eye(n)), out=result[:, first : first + n])
        at_c = constants + n * n + n
        result[:, first + n : first + 2 * n] = jacobian[:, at_c : at_c + n]
        if self.feedthrough:
            result[:, -1] = jacobian[:, -1]

    def gauges(self, theta: Array) -> tuple[Array, Array]:
        """Give what must be zero, and its derivatives by theta, one row each."""
        value, row = self._dc_gain(theta)
        values, rows = [value - 1.0], [row]
        if self.front.gauge is not None:
            values.append(float(self.front.gauge @ theta[: self.front_size]) - 1.0)
            rows.append(np.pad(self.front.gauge, (0, theta.size - self.front_size)))
        return np.array(values), np.array(rows)

    def _dc_gain(self, theta: Array) -> tuple[float, Array]:
        G, n = self.dynamics(theta), self.base.order
        x = np.linalg.solve(np.eye(n) - G.A, G.B)
        row = np.zeros(theta.size)
        row[self.front_size : self.front_size + n] = float(G.C @ x) * x
        row[self.front_size + n : self.front_size + 2 * n] = x
        row[self.front_size + 2 * n :] = 1.0
        return float(G.C @ x) + G.D, row

    def bounds(self) -> tuple[Array, Array]:
        """Give lower and upper bounds of theta; the dynamics have none."""
        free = np.full(self.size - self.front_size, np.inf)
        parametrization = self.front.parametrization
        return (
            np.concatenate([parametrization.lower, -free]),
            np.concatenate([parametrization.upper, free]),
        )

    def canonical(self, theta: Array) -> Array:
        """Sort the plays."""
        front = self.front.parametrization.canonical(theta[: self.front_size])
        return np.concatenate([front, theta[self.front_size :]])


def simulated(joint: Joint, data: Data, theta: Array) -> Array:
    """Give the output of the whole model of a joint theta over the samples of data used."""
    return model_output(data, joint.dynamics(theta) @ joint.hysteresis(theta))


def derivative(joint: Joint, data: Data, theta: Array) -> Array:
    """Give the derivative by theta of what ``simulated`` gives for joint and data."""
    model = joint.dynamics(theta) @ joint.hysteresis(theta)
    windows = data.windows()
    result = np.empty((sum(w.stop - w.start for w in windows), joint.size))
    row = 0
    for record, window in zip(data.records, windows, strict=True):
        rows = result[row : row + window.stop - window.start]
        joint.project(model.jacobian(record.u[: window.stop])[window], rows)
        row += len(rows)
    return result


def refine(joint: Joint, data: Data, max_iterations: int) -> Solution:
    """Minimise the simulated output error over hysteresis and dynamics.

    A hysteresis richer or poorer than the actuator's leaves a long flat valley. So it has
    converged, too, when a dozen steps lower the squared error by no more than a hundredth.

    Parameters
    ----------
    joint
        Free parameters.
    data
        The records.
    max_iterations
        At most.

    Returns
    -------
    Solution
    """
    problem, theta, before = _problem(joint, data), joint.start(), np.inf
    for done in range(_BURST, max(max_iterations, _BURST) + 1, _BURST):
        found = minimize(problem, theta, _BURST, _TOLERANCE)
        if found.status == CONVERGED or found.cost > _STALLED * before:
            return Solution(found.theta, found.cost, done - _BURST + found.iterations, CONVERGED)
        theta, before = found.theta, found.cost
    return found


def refined_coarsely(joint: Joint, data: Data, max_iterations: int) -> tuple[Joint, float]:
    """Refine a joint guess on the beginning of the data; give a new guess and its cost.

    A play whose weight came out zero has no gradient by its radius any more: it is set to
    half of the smallest other radius, and the refinement, of ``max_iterations`` at most, is
    tried again.
    """
    short = shortened(data, _WARM_UP)
    best = minimize(_problem(joint, short), joint.start(), max_iterations, 1.0)
    reseeded = _with_idle_plays_moved(joint, best.theta)
    if reseeded is not None:
        again = minimize(_problem(joint, short), reseeded, max_iterations, 1.0)
        best = min(best, again, key=lambda each: each.cost)
    theta = joint.canonical(best.theta)
    front = replace(joint.front, theta=theta[: joint.front_size])
    return Joint(front, joint.dynamics(theta), joint.feedthrough), best.cost


def _with_idle_plays_moved(joint: Joint, theta: Array) -> Array | None:
    parametrization = joint.front.parametrization
    n = parametrization.plays
    lower, upper = joint.bounds()
    weights, radii = slice(1, n + 1), slice(n + 1, 2 * n + 1)
    total = float(np.abs(theta[: n + 1]).sum())
    idle = np.flatnonzero(theta[weights] <= 1e-2 * total)
    if n == 0 or idle.size == 0 or (lower[radii] == upper[radii]).all():
        return None
    moved = theta.copy()
    for play in idle:
        others = np.delete(moved[radii], play)
        moved[n + 1 + play] = 0.5 * float(others.min(initial=float(upper[n + 1])))
        moved[1 + play] = 0.05 * total
    return joint.canonical(np.clip(moved, lower, upper))


def shortened(data: Data, samples: int) -> Data:
    """Keep the beginning of the records of data, so many samples of each after its start."""
    if all(len(r) - s <= samples for r, s in zip(data.records, data.starts, strict=True)):
        return data
    records = tuple(
        r.slice(0, min(len(r), s + samples)) for r, s in zip(data.records, data.starts, strict=True)
    )
    return replace(data, records=records)


def _problem(joint: Joint, data: Data) -> Problem:
    y = data.measured()
    spread = float(np.linalg.norm(y - y.mean()))
    lower, upper = joint.bounds()

    def residual(theta: Array) -> Array:
        count = 1 + int(joint.front.gauge is not None)
        if not joint.dynamics(theta).is_stable():
            # No model of a stable actuator: a cost that no step is taken to.
            return np.full(y.size + count, 1e3 * spread)
        gauges = joint.gauges(theta)[0]
        return np.concatenate([simulated(joint, data, theta) - y, 10.0 * spread * gauges])

    def linearize(theta: Array) -> tuple[Array, Array]:
        rows = 10.0 * spread * joint.gauges(theta)[1]
        return residual(theta), np.concatenate([derivative(joint, data, theta), rows])

    rounding = (1e-13 * spread) ** 2 * max(y.size, 1)
    return Problem(linearize, residual, lower, upper, joint.canonical, rounding)


def within_gauges(joint: Joint, theta: Array, inside: NDArray[np.bool_]) -> Array:
    """Give a basis of the directions of theta that keep the gauges and touch no bound.

    Parameters
    ----------
    joint, theta
        Where.
    inside
        Shape (m,): which parameters may move.

    Returns
    -------
    numpy.ndarray
        Shape (m, free directions).
    """
    rows = joint.gauges(theta)[1][:, inside]
    basis = np.zeros((theta.size, int(inside.sum()) - len(rows)))
    basis[inside] = scipy.linalg.null_space(rows / np.linalg.norm(rows, axis=1, keepdims=True))
    return basis
