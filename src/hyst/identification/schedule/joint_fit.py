"""One least squares problem over all values of a second signal, some parameters in common."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.bounded_least_squares import Problem, Solution, minimize

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

LEAST_NOISE = 0.1
"""Of the noisiest value's: no value counts as if it were less noisy."""


@dataclass(frozen=True, eq=False)
class _Joint:
    """The joint problem: what is shared, then what moves, value after value.

    Parameters
    ----------
    problems, weights
        The problem at each value, and one over its noise.
    shared
        Shape (m,), the parameters that have one value.
    """

    problems: Sequence[Problem]
    weights: Sequence[float]
    shared: Mask

    def apart(self, joint: Array) -> Array:
        """Give the parameters at each value, shape (values, m)."""
        count, values = int(self.shared.sum()), len(self.problems)
        split = np.empty((values, self.shared.size))
        split[:, self.shared] = joint[:count]
        split[:, ~self.shared] = joint[count:].reshape(values, -1)
        return split

    def together(self, split: Array) -> Array:
        """Give the joint parameters of those at each value."""
        return np.concatenate([split[:, self.shared].mean(axis=0), split[:, ~self.shared].ravel()])

    def residual(self, joint: Array) -> Array:
        parts = zip(self.problems, self.weights, self.apart(joint), strict=True)
        return np.concatenate([weight * each.residual(theta) for each, weight, theta in parts])

    def linearize(self, joint: Array) -> tuple[Array, Array]:
        errors, rows = [], []
        moving = ~self.shared
        first, own = int(self.shared.sum()), int(moving.sum())
        parts = zip(self.problems, self.weights, self.apart(joint), strict=True)
        for each, weight, theta in parts:
            error, jacobian = each.linearize(theta)
            row = np.zeros((error.size, joint.size))
            row[:, : int(self.shared.sum())] = jacobian[:, self.shared]
            row[:, first : first + own] = jacobian[:, moving]
            errors.append(weight * error)
            rows.append(weight * row)
            first += own
        return np.concatenate(errors), np.concatenate(rows)

    def canonical(self, joint: Array) -> Array:
        """Give the form of each value, where they agree about what is shared."""
        pairs = zip(self.problems, self.apart(joint), strict=True)
        ordered = np.array([each.canonical(theta) for each, theta in pairs])
        agree = (ordered[:, self.shared] == ordered[0, self.shared]).all()
        return self.together(ordered) if agree else joint

    def problem(self) -> Problem:
        """Give it as a problem."""
        pairs = list(zip(self.problems, self.weights, strict=True))
        return Problem(
            self.linearize,
            self.residual,
            self.together(np.array([each.lower for each in self.problems])),
            self.together(np.array([each.upper for each in self.problems])),
            self.canonical,
            negligible=sum(weight**2 * each.negligible for each, weight in pairs),
            is_linear=all(each.is_linear for each in self.problems),
        )


def fit_jointly(
    problems: Sequence[Problem],
    noises: Sequence[float],
    shared: Mask,
    thetas: Array,
    max_iterations: int,
) -> tuple[Array, Solution]:
    """Minimise the squared errors at all values, each in units of its noise.

    Parameters
    ----------
    problems
        The problem at each value.
    noises
        Of each, output units, above 0.
    shared
        Shape (m,), the parameters that have one value.
    thetas
        Shape (values, m), the start, in which they agree.
    max_iterations
        At most.

    Returns
    -------
    thetas : numpy.ndarray
        Shape (values, m).
    solution : Solution
        Of the joint problem.
    """
    least = LEAST_NOISE * max(noises)
    joint = _Joint(problems, [1.0 / max(each, least) for each in noises], shared)
    solution = minimize(joint.problem(), joint.together(thetas), max_iterations)
    return joint.apart(solution.theta), solution
