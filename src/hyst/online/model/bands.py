"""Bands of constants, from the squares themselves, and what is not determined."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtri

from hyst.online.knowledge import Knowledge
from hyst.online.model.block_fit import clip_of, squares_of
from hyst.online.model.course import Course
from hyst.online.model.profile import Profile

Array = NDArray[np.float64]

_BAND, _RISE, _OUTSIDE = 2.0, 4.0, 0.05
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
    profile = _profile(course)
    recent = course.free_covariance(course.recent, _BELIEF)
    likely = _as_likely(course)
    for k, place in enumerate(course.free.tolist()):
        width = _widths(course, profile, covariance, k)
        low[place] = min(course.theta[place] - width[0], likely[:, place].min())
        high[place] = max(course.theta[place] + width[1], likely[:, place].max())
        error = max(float(np.sqrt(recent[k, k])), float(high[place] - low[place]) / (2.0 * _BAND))
        reason = _missing(course, place, error)
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


def _widths(course: Course, profile: Profile, covariance: Array, k: int) -> tuple[float, float]:
    """Give how far the band goes down and up, at least two standard errors."""
    error = float(np.sqrt(covariance[k, k]))
    if not error > 0.0:
        return 0.0, 0.0
    scale = profile.scale
    step = _BAND * covariance[k] / (error * scale)
    farthest = _BAND * float(course.spread[course.free[k]] / scale[k])
    down, up = (profile.reach(k, sign * step, farthest) for sign in (-1.0, 1.0))
    return max(down, _BAND * error), max(up, _BAND * error)


def _as_likely(course: Course) -> Array:
    """Give the estimate, and those from other starts that the window does not tell from it.

    Their squares are within the 95 % region of as many constants, ridges and kinks and all.
    """
    task = course.task()
    window = task.window

    def error_of(theta: Array) -> Array:
        return window.y[: window.count] - window.outputs(theta)[0]

    error = error_of(course.theta)
    clip = clip_of(error, task.weights)
    region = float(chdtri(max(course.free.size, 1), _OUTSIDE)) * course.variance
    most = squares_of(error, task.weights, clip) + region
    with np.errstate(all="ignore"):
        found = [
            rival
            for rival in course.rivals
            if squares_of(error_of(rival), task.weights, clip) <= most
        ]
    return np.array([course.theta, *found])


def _profile(course: Course) -> Profile:
    """Give what counts as likely: four variances of the noise, of all samples as of the window."""
    task = course.task()
    here = float(task.weights.sum())
    all_of_them = here + course.regularities.samples
    most = _RISE * course.variance * here / max(all_of_them, 1.0)
    return Profile(
        task.window, task.weights, course.theta, task.free, task.scale,
        course.lower, course.upper, most,
    )  # fmt: skip
