"""A signal at the sample time of a controller."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError

Array = NDArray[np.float64]

MOST_SAMPLES = 10_000_000
# Rates that are proposed are given in 12 digits, so that they pass.
_WHOLE = 1e-9  # of a number of samples: what sample times as decimals leave of a whole one


@final
@dataclass(frozen=True, eq=False)
class Resampled:
    """A signal at other times.

    Parameters
    ----------
    values
        Shape (N,).
    dt
        Between them, s.
    sentence
        How they were made, and what it costs.
    lost
        Most by which straight lines between them are off the signal's own samples, its units.
    """

    values: Array
    dt: float
    sentence: str
    lost: float


def resampled(
    signal: Array, dt: float, wanted: float, repeat: bool, name: str, unit: str
) -> Resampled:
    """Give a signal every ``wanted`` seconds, between its own samples by straight lines.

    Parameters
    ----------
    signal, dt
        Shape (n,), every ``dt`` seconds.
    wanted
        Sample time of the controller, s.
    repeat
        Whether the first sample follows the last; else the last is kept.
    name, unit
        Of the signal, for people.

    Raises
    ------
    InputError
        If a signal that repeats has no whole number of the controller's samples, or there would be
        too many.
    """
    last = signal.size if repeat else signal.size - 1
    count = _count(last * dt / wanted, repeat, last * dt)
    step = wanted / dt
    places = np.arange(count) * step
    if _is_whole(step):
        places = np.arange(count) * float(round(step))
    elif _is_whole(1.0 / step):
        places = np.arange(count) / float(round(1.0 / step))
    else:
        near = np.rint(places)  # a sample of the signal where rounding alone is between
        places = np.where(np.abs(places - near) <= _WHOLE * np.maximum(near, 1.0), near, places)
    closed = np.append(signal, signal[0] if repeat else signal[-1])
    values = _at(closed, np.minimum(places, float(last)))
    ends = np.append(values, values[0] if repeat else values[-1])
    back = _at(ends, np.minimum(np.arange(signal.size) / step, float(count)))
    lost = float(np.abs(back - signal).max())
    bent = np.append(closed, closed[1]) if repeat else signal
    bend = float(np.abs(np.diff(bent, 2)).max(initial=0.0)) / 8.0
    return Resampled(values, wanted, _sentence(step, name, unit, lost, bend), lost)


def _count(samples: float, repeat: bool, duration: float) -> int:
    """Give how many samples of the controller there are."""
    if not samples <= MOST_SAMPLES:
        raise InputError(
            f"the table would have {samples:.3g} points, more than {MOST_SAMPLES}; give a lower "
            "rate of the controller"
        )
    whole = round(samples)
    near = abs(samples - whole) <= _WHOLE * max(samples, 1.0)
    if not repeat:
        return whole + 1 if near else math.floor(samples) + 2
    if not near or whole < 1:
        low, high = max(math.floor(samples), 1), math.ceil(samples)
        raise InputError(
            f"the period of {duration:.9g} s is {samples:.9g} samples of the controller; a wave "
            f"that repeats has a whole number of them, as at {low / duration:.12g} or "
            f"{max(high, low + 1) / duration:.12g} Hz"
        )
    return whole


def _is_whole(ratio: float) -> bool:
    return round(ratio) >= 1 and abs(ratio - round(ratio)) <= _WHOLE * ratio


def _at(values: Array, places: Array) -> Array:
    """Give values between samples by straight lines, and at samples their own bits."""
    below = np.minimum(np.floor(places).astype(np.int64), values.size - 1)
    above = np.minimum(below + 1, values.size - 1)
    share = places - below
    between = values[below] + share * (values[above] - values[below])
    given: Array = np.where(share == 0.0, values[below], between)
    return given


def _sentence(step: float, name: str, unit: str, lost: float, bend: float) -> str:
    behind = f" {unit}" if unit else ""
    if _is_whole(step) and round(step) == 1:
        return f"every sample of {name} is a point of the table"
    if _is_whole(step):
        return (
            f"one of {round(step)} samples of {name} is a point of the table, unchanged; straight "
            f"lines between the points are off the others by up to {lost:.3g}{behind}"
        )
    by = f"straight lines between the samples of {name}, which may be off a smooth signal by "
    if _is_whole(1.0 / step):
        return f"points between are on {by}up to {bend:.3g}{behind}"
    return (
        f"the points are on {by}up to {bend:.3g}{behind}; straight lines between the points are "
        f"off the samples by up to {lost:.3g}{behind}"
    )
