"""Bands of constants, from the squares themselves, and what is not determined."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.online.knowledge import Knowledge
from hyst.online.model.block_fit import clip_of, squares_of
from hyst.online.model.course import Course

Array = NDArray[np.float64]

_BAND, _RISE = 2.0, 4.0
_WIDENINGS = 4
_LEARNT = 0.5
# Of the start, where it is asked what samples tell without it.
_BELIEF = 0.1


def known_of(course: Course) -> Knowledge:
    """Say what is known of each constant.

    Parameters
    ----------
    course
        The estimate.

    Returns
    -------
    Knowledge
    """
    count = course.theta.size
    low, high = course.theta.copy(), course.theta.copy()
    determined, reasons = np.ones(count, bool), [""] * count
    innovation = course.innovation()
    covariance = course.free_covariance(course.information)
    recent = course.free_covariance(course.recent, _BELIEF)
    for k, place in enumerate(course.free.tolist()):
        width = _widths(course, covariance, k)
        low[place], high[place] = course.theta[place] - width[0], course.theta[place] + width[1]
        reason = _missing(course, place, float(np.sqrt(recent[k, k])))
        if not reason and not innovation.consistent:
            reason = str(innovation)
        determined[place], reasons[place] = not reason, reason
    for place in np.flatnonzero(course.spread == 0.0).tolist():
        reasons[place] = _why_held(course, place)
        determined[place] = course.names[place] in course.held
    said = () if innovation.consistent else (f"bands cannot be believed: {innovation}",)
    return Knowledge(course.names, low, high, determined, tuple(reasons), said)


def _why_held(course: Course, place: int) -> str:
    name = course.names[place]
    if name in course.settings["held"]:
        return "held"
    if name in course.held:
        return "held: fixed, or another stage has its scale"
    return "it starts at 0, which tells no size; give one in spreads, or another start"


def _missing(course: Course, place: int, error: float) -> str:
    """Say why recent samples do not determine a constant, or nothing."""
    spread = float(course.spread[place])
    if error <= _LEARNT * spread:
        return ""
    memory = course.settings["memory"]
    when = "samples so far" if memory is None else f"samples of the last {memory:.4g} s"
    return (
        f"{when} leave a standard error of {error:.3g} to {course.theta[place]:.4g}, the start one "
        f"of {spread:.3g}; drive it more, or believe the start"
    )


def _widths(course: Course, covariance: Array, k: int) -> tuple[float, float]:
    """Give how far the band goes down and up: where the squares have risen by four variances."""
    error = float(np.sqrt(covariance[k, k]))
    if not error > 0.0:
        return 0.0, 0.0
    direction = np.zeros_like(course.theta)
    direction[course.free] = covariance[k] / error
    down, up = (_reach(course, sign * direction) * error for sign in (-1.0, 1.0))
    return down, up


def _reach(course: Course, direction: Array) -> float:
    """Go along a direction, two standard errors or more, until the squares have risen enough."""
    task = course.task()
    window, clip = task.window, np.inf
    squares = []
    with np.errstate(all="ignore"):
        for reach in (0.0, *(_BAND * 2.0 ** (i / 2.0) for i in range(_WIDENINGS + 1))):
            theta = course.theta + reach * direction
            error = window.y[: window.count] - window.outputs(theta)[0]
            clip = clip_of(error, task.weights) if reach == 0.0 else clip
            x, x0 = (each[course.free] / task.scale for each in (theta, course.theta))
            more = task.past.cost(x, x0) + course.variance * float(
                np.sum((x - task.start) ** 2) - np.sum((x0 - task.start) ** 2)
            )
            squares.append(squares_of(error, task.weights, clip) + more)
            if reach and not squares[-1] < squares[0] + _RISE * course.variance:
                return float(reach)
    return float(_BAND * 2.0 ** (_WIDENINGS / 2.0))
