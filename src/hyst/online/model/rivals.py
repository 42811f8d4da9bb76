"""Estimates from other starts: a search for a better minimum of the squares."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from hyst.online.model.block_fit import Fitted, Task, clip_of, fitted, squares_of
from hyst.online.model.constrained_step import constrained_step

Array = NDArray[np.float64]

_PASSES = 8
_NEAR = 0.5
_BEYOND_DOUBT = 3.0
_MUCH_LESS = 0.5


def rival_of(
    task: Task,
    theta: Array,
    trial: int,
    floor: float,
    judge: Callable[[Array], tuple[float, float]],
) -> tuple[Fitted, bool] | None:
    """Fit the window from another start; tell whether its errors are smaller beyond doubt.

    Parameters
    ----------
    task
        The window, without the past, which the present estimate has coloured.
    theta
        The present estimate, shape (m,).
    trial
        Number of the trial, from which the start is drawn: in turn about the start of all, and
        about the present estimate.
    floor
        Least variance of the noise.
    judge
        Tells how far errors of constants are from noise, above 1 if they are none.

    Notes
    -----
    Vuong (1989): differences of squares over their own standard error. Where the errors of the
    rival are no noise either, neighbours do not tell anew, and it must halve the squares.
    """
    begin = _drawn(task, theta, trial)
    try:
        found = None if begin is None else fitted(task, begin, 0.0, floor, _PASSES)
    except np.linalg.LinAlgError:
        return None
    if found is None:
        return None
    window = task.window
    errors = [window.y[: window.count] - window.outputs(each)[0] for each in (theta, found.theta)]
    clip = clip_of(errors[0], task.weights)
    squares = [squares_of(error, task.weights, clip) for error in errors]
    sizes = [np.minimum(np.abs(error), clip) ** 2 for error in errors]
    gained = (task.weights * (sizes[0] - sizes[1]))[task.weights > 0.0]
    is_sure = gained.sum() > _BEYOND_DOUBT * np.sqrt(gained.size) * float(np.std(gained))
    is_noise = squares[1] < _MUCH_LESS * squares[0] or max(judge(found.theta)) <= 1.0
    return found, bool(is_sure and is_noise)


def _drawn(task: Task, theta: Array, trial: int) -> Array | None:
    rng = np.random.default_rng([20, trial])
    x = theta[task.free] / task.scale
    far = rng.standard_normal(x.size)
    to = task.start + far if trial % 2 else x + _NEAR * far
    rows = task.rows[:, task.free] * task.scale
    slack = np.minimum(task.least - task.rows @ theta, 0.0)
    bound = task.lower[task.free]
    below = np.isfinite(bound)
    rows = np.vstack([rows, np.diag(task.scale)[below]])
    slack = np.concatenate([slack, 0.9 * (bound - theta[task.free])[below]])
    step = constrained_step(np.eye(x.size), to - x, rows, slack)
    begin = theta.copy()
    begin[task.free] += task.scale * step
    return task.admissible(begin)
