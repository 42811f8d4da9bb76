"""One least squares problem over all values of a second signal, some parameters in common."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.bounded_least_squares import Problem, Solution, minimize

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

LEAST_NOISE = 0.1
"""Of the noisiest value's: no value counts as if it were less noisy."""


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
        Of each, output units.
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
    moving = ~shared
    count, own = int(shared.sum()), int(moving.sum())
    least = LEAST_NOISE * max(noises)
    weights = [1.0 / max(each, least) if least > 0.0 else 1.0 for each in noises]

    def apart(joint: Array) -> Array:
        split = np.empty((len(problems), shared.size))
        split[:, shared] = joint[:count]
        split[:, moving] = joint[count:].reshape(len(problems), own)
        return split

    def together(split: Array) -> Array:
        return np.concatenate([split[:, shared].mean(axis=0), split[:, moving].ravel()])

    def residual(joint: Array) -> Array:
        parts = zip(problems, weights, apart(joint), strict=True)
        return np.concatenate([weight * each.residual(theta) for each, weight, theta in parts])

    def linearize(joint: Array) -> tuple[Array, Array]:
        errors, rows = [], []
        for v, (each, weight, theta) in enumerate(
            zip(problems, weights, apart(joint), strict=True)
        ):
            error, jacobian = each.linearize(theta)
            row = np.zeros((error.size, joint.size))
            row[:, :count] = jacobian[:, shared]
            row[:, count + v * own : count + (v + 1) * own] = jacobian[:, moving]
            errors.append(weight * error)
            rows.append(weight * row)
        return np.concatenate(errors), np.concatenate(rows)

    def canonical(joint: Array) -> Array:
        split = apart(joint)
        ordered = np.array(
            [each.canonical(theta) for each, theta in zip(problems, split, strict=True)]
        )
        agree = (ordered[:, shared] == ordered[0, shared]).all()
        return together(ordered) if agree else joint

    lower, upper = (
        together(np.array([getattr(each, end) for each in problems])) for end in ("lower", "upper")
    )
    whole = Problem(
        linearize,
        residual,
        lower,
        upper,
        canonical,
        negligible=sum(
            weight**2 * each.negligible for each, weight in zip(problems, weights, strict=True)
        ),
        is_linear=all(each.is_linear for each in problems),
    )
    solution = minimize(whole, together(thetas), max_iterations)
    return apart(solution.theta), solution
