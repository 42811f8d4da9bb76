"""The estimate that fits the window, the past and what was believed at the start, together."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.online.model.constrained_step import constrained_step
from hyst.online.model.past import Past
from hyst.online.model.window import Window

Array = NDArray[np.float64]

_TRIALS, _SHORTER = 5, 0.4
_ENOUGH = 1e-3
_CLIP, _SHARE, _NORMAL = 8.0, 0.9, 1.645
_SHRINK = 0.2

Admissible = Callable[[Array], Array | None]


@final
@dataclass(frozen=True, eq=False)
class Task:
    """What is fitted.

    Parameters
    ----------
    window
        The last samples.
    weights
        Shape (N,), by age; 0 where the output was not measured.
    past
        What earlier samples tell.
    free
        Shape (f,), places of the constants that are estimated.
    scale
        Shape (f,), their spreads: ``theta[free] = scale x``.
    start
        Shape (f,), x at the start, off by 1 in each entry.
    rows, least
        Inequalities of all constants.
    lower
        Shape (m,), bounds that are approached but not passed.
    admissible
        Gives a vector of constants with its roundings mended, or None if it has no inverse.
    """

    window: Window
    weights: Array
    past: Past
    free: NDArray[np.intp]
    scale: Array
    start: Array
    rows: Array
    least: Array
    lower: Array
    admissible: Admissible


@final
@dataclass(frozen=True, eq=False)
class Fitted:
    """An estimate and what it rests on.

    Parameters
    ----------
    theta
        Shape (m,).
    variance
        Of the noise.
    information
        Shape (f, f), of the window, output units squared.
    columns, columns_before
        Shape (N, f), derivative of the output by x there, and where the steps began.
    squares
        Of the window, large errors counted less.
    refused
        Steps that were refused since what they led to has no inverse.
    """

    theta: Array
    variance: Array | float
    information: Array
    columns: Array
    columns_before: Array
    squares: float
    refused: int


def clip_of(error: Array, weights: Array) -> float:
    """Give beyond which size an error counts as an outlier; infinity where none can be told."""
    sizes = np.abs(error[weights > 0.0])
    usual = float(np.quantile(sizes, _SHARE)) if sizes.size else 0.0
    return _CLIP / _NORMAL * usual if usual > 0.0 else np.inf


def squares_of(error: Array, weights: Array, clip: float) -> float:
    """Sum squares, beyond the clip growing in line with the size (Huber)."""
    size = np.abs(np.where(weights > 0.0, error, 0.0))
    inner = np.minimum(size, clip)
    return float(weights @ (inner * (2.0 * size - inner)))


def fitted(task: Task, theta: Array, variance: float, floor: float, passes: int) -> Fitted | None:
    """Improve an estimate by Gauss-Newton steps.

    Parameters
    ----------
    task
        What is fitted.
    theta
        Shape (m,), where to start, admissible.
    variance
        Of the noise, as known before; where it is 0, of the errors there are.
    floor
        Least variance of the noise.
    passes
        Most steps.

    Returns
    -------
    Fitted or None
        None where an output or a derivative is not finite.
    """
    refused, clip, count = 0, np.inf, float(task.weights.sum())
    before = np.zeros((0, task.start.size))
    for pass_ in range(passes + 1):
        with np.errstate(all="ignore"):
            y, jacobian = task.window.sensitivity(theta)
            error = task.window.y[: y.size] - y
            if pass_ == 0:
                clip = clip_of(error, task.weights)
            size = np.abs(error)
            weights = task.weights * np.where(size > clip, clip / size, 1.0)
            columns = jacobian[:, task.free] * task.scale
            information = columns.T @ (columns * weights[:, None])
            pull = columns.T @ (weights * error)
        before = before if pass_ else columns
        squares = squares_of(error, task.weights, clip)
        if not (np.isfinite(information).all() and np.isfinite(pull).all() and squares < np.inf):
            return None
        variance = _variance(task, information, squares, count, variance, floor)
        if pass_ == passes:
            break
        step = _step(task, theta, information, pull, variance)
        found, more = _searched(task, theta, step, squares, variance, clip)
        refused += more
        if found is None:
            break
        theta, gained = found
        if gained < _ENOUGH * variance:
            break
    return Fitted(theta, variance, information, columns, before, squares, refused)


def _variance(
    task: Task, information: Array, squares: float, count: float, before: float, floor: float
) -> float:
    """Give the squares over what is left of samples once constants have taken theirs."""
    level = before if before > 0.0 else squares / max(count, 1.0)
    whole = information + task.past.information + max(level, floor) * np.eye(task.start.size)
    taken = float(np.trace(np.linalg.solve(whole, information))) if task.start.size else 0.0
    return max(squares / max(count - taken, 0.1 * count, 1.0), floor)


def _step(task: Task, theta: Array, information: Array, pull: Array, variance: float) -> Array:
    x = theta[task.free] / task.scale
    whole = information + task.past.information + variance * np.eye(x.size)
    force = pull + task.past.pull(x) + variance * (task.start - x)
    rows = task.rows[:, task.free] * task.scale
    slack = np.minimum(task.least - task.rows @ theta, 0.0)
    bound = task.lower[task.free]
    is_bound = np.isfinite(bound) & (theta[task.free] > bound)
    near = np.diag(task.scale)[is_bound]
    room = (1.0 - _SHRINK) * (bound - theta[task.free])[is_bound]
    d = constrained_step(
        whole / variance, force / variance, np.vstack([rows, near]), np.concatenate([slack, room])
    )
    step = np.zeros_like(theta)
    step[task.free] = task.scale * d
    return step


def _searched(
    task: Task, theta: Array, step: Array, squares: float, variance: float, clip: float
) -> tuple[tuple[Array, float] | None, int]:
    """Go along a step until the squares are less; shorten it where they are not."""
    refused, share = 0, 1.0
    for _ in range(_TRIALS):
        trial = task.admissible(theta + share * step)
        if trial is None:
            refused += 1
        elif (trial != theta).any():
            gained = _gain(task, theta, trial, squares, variance, clip)
            if gained > 0.0:
                return (trial, gained), refused
        share *= _SHORTER
    return None, refused


def _gain(
    task: Task, theta: Array, trial: Array, squares: float, variance: float, clip: float
) -> float:
    with np.errstate(all="ignore"):
        y, _ = task.window.outputs(trial)
        there = squares_of(task.window.y[: y.size] - y, task.weights, clip)
    x, to = theta[task.free] / task.scale, trial[task.free] / task.scale
    believed = variance * float(np.sum((to - task.start) ** 2) - np.sum((x - task.start) ** 2))
    gained = squares - there - task.past.cost(to, x) - believed
    return gained if np.isfinite(gained) else -np.inf
