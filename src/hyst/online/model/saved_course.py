"""All numbers of a running estimate as one vector, and back."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.errors import InputError
from hyst.online.estimator_file import restored_state
from hyst.online.model.commands import refusal_of
from hyst.online.model.course import Course
from hyst.online.model.past import Past
from hyst.online.model.turns import MOST

Array = NDArray[np.float64]

_AGAIN = "which no estimator reaches; save the estimator again"


def numbers_of(course: Course) -> Array:
    """Give all that the next sample depends on.

    Parameters
    ----------
    course
        The estimate.
    """
    parts = [
        _scalars(course), course.theta, course.theta_start, course.spread,
        course.window.state, course.window.theta_at, course.memory,
    ]  # fmt: skip
    window, count = course.window, course.window.count
    room = course.room - count
    parts += [course.rivals.ravel(), window.turns, np.zeros(MOST - window.turns.size)]
    for each in (window.u, window.y, window.told):
        parts.append(np.concatenate([each[:count], np.zeros(room)]))
    past = course.past
    matrices = (past.information, past.recent, course.information, course.recent, window.tangents)
    parts += [past.told, course.regularities.numbers, *(each.ravel() for each in matrices)]
    return np.concatenate(parts)


def course_of(course: Course, saved: ArrayLike) -> None:
    """Bring an estimate that has just begun to where it was saved.

    Parameters
    ----------
    course
        Of the same settings, changed in place.
    saved
        What ``numbers_of`` gave.

    Raises
    ------
    InputError
        If there are more or fewer numbers, one is not finite, or the estimate is none that can
        have been reached.
    """
    given = np.asarray(saved, dtype=np.float64).ravel()
    m, scalars = course.theta.size, _scalars(course).size
    if given.size >= scalars + 3 * m:
        spread = given[scalars + 2 * m : scalars + 3 * m]
        if np.isfinite(spread).all() and (spread >= 0.0).all():
            free = int((spread > 0.0).sum())
            course.free = np.flatnonzero(spread > 0.0)
            course.past = Past.none(free)
            course.information = course.recent = np.zeros((free, free))
    live = np.zeros(numbers_of(course).size)
    restored_state(live, given)
    _take(course, live)


def _scalars(course: Course) -> Array:
    counts = [float(each) for each in course.counts.values()]
    flags = [float(course.is_begun), float(course.has_left)]
    whole = [course.trials, course.replacements, course.wait, course.in_block, course.window.count]
    numbers = [course.last_input, course.error, course.variance]
    flags += [float(course.window.recalls), float(course.window.turns.size)]
    return np.array([*numbers, *flags, *map(float, whole), *counts])


def _take(course: Course, numbers: Array) -> None:
    at = 0

    def next_of(shape: tuple[int, ...]) -> Array:
        nonlocal at
        count = int(np.prod(shape))
        part = numbers[at : at + count].reshape(shape).copy()
        at += count
        return part

    scalars = next_of(_scalars(course).shape)
    m, n, f = course.theta.size, course.window.state.size, course.free.size
    theta, start, course.spread = next_of((m,)), next_of((m,)), next_of((m,))
    window = course.window
    window.state, window.theta_at, memory = next_of((n,)), next_of((m,)), next_of((n,))
    course.rivals = next_of(course.rivals.shape)
    window.turns = next_of((MOST,))
    window.u, window.y, window.told = (next_of((course.room,)) for _ in range(3))
    told, course.regularities.numbers = next_of((f,)), next_of(course.regularities.numbers.shape)
    information, recent = next_of((f, f)), next_of((f, f))
    course.past = Past(information, told, recent)
    course.information, course.recent = next_of((f, f)), next_of((f, f))
    window.tangents = next_of((n, m))
    _take_scalars(course, scalars)
    _require_estimate(course, theta, start)
    course.theta_start = start
    course.set_estimate(theta)
    course.take_memory(memory)


def _take_scalars(course: Course, scalars: Array) -> None:
    course.last_input, course.error, course.variance = scalars[:3].tolist()
    whole = scalars[3:]
    if (whole < 0.0).any() or (whole != np.floor(whole)).any() or course.variance < 0.0:
        raise InputError(f"the saved estimate has counts or a variance below 0, {_AGAIN}")
    course.is_begun, course.has_left = bool(whole[0]), bool(whole[1])
    course.window.recalls = bool(whole[2])
    course.window.turns = course.window.turns[: int(whole[3])]
    places = [int(each) for each in whole[4:]]
    course.trials, course.replacements, course.wait, course.in_block = places[:4]
    course.window.count = places[4]
    if course.window.count > course.room or course.in_block > course.block:
        raise InputError(f"the saved window holds {places[4]} samples of {course.room}, {_AGAIN}")
    course.counts = dict(zip(course.counts, places[5:], strict=True))


def _require_estimate(course: Course, theta: Array, start: Array) -> None:
    for each in (theta, start):
        why = refusal_of(course.model.with_parameters(each))
        if why:
            raise InputError(f"the saved estimate cannot be inverted: {why}")
