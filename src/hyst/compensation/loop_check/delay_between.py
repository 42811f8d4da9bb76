"""The delay that would bring loops of several frequencies onto each other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hyst.compensation.loop_check.loop_shape import DELAYS, LoopShape
from hyst.compensation.loop_check.repeated_cycles import RepeatedCycles

Array = NDArray[np.float64]

_STEPS = 6


def remaining_delay(
    shapes: Sequence[LoopShape], cycles: Sequence[RepeatedCycles], dt: float
) -> tuple[float, list[Array]]:
    """Fit the delay that v still has, by weighted least squares, and take it back.

    A delay turns harmonic n of a sine by n times the angle it is of a cycle, so it is told from
    what widens loops otherwise by two harmonics, or by two frequencies.

    Parameters
    ----------
    shapes
        Of each loop.
    cycles
        Their stretches.
    dt
        Sample time, s.

    Returns
    -------
    delay : float
        s, positive where v comes late.
    beside : list of numpy.ndarray
        What v would have beside the model without the delay.
    """
    weight = np.array([1.0 / each.variance for each in shapes])[:, :, None]
    delay = 0.0
    for _ in range(_STEPS):
        moved = [_moved(*each, dt, delay) for each in zip(shapes, cycles, strict=True)]
        left = np.array([beside for beside, _ in moved])
        slope = np.array([by_delay for _, by_delay in moved])
        mean = (weight * left).sum(axis=0) / weight.sum(axis=0)
        middle = (weight * slope).sum(axis=0) / weight.sum(axis=0)
        own, free = left - mean, slope - middle
        power = float((weight * np.square(free)).sum())
        if power == 0.0:
            break
        delay -= float((weight * free * own).sum()) / power
    return delay, [_moved(*each, dt, delay)[0] for each in zip(shapes, cycles, strict=True)]


def _moved(
    shape: LoopShape, cycles: RepeatedCycles, dt: float, delay: float
) -> tuple[Array, Array]:
    """Give what is beside the model without ``delay`` seconds of v, and its slope by them."""
    if not cycles.is_sine:
        samples = float(np.clip(delay / dt, DELAYS[0], DELAYS[-1]))
        place = min(int(np.searchsorted(DELAYS, samples, side="right")) - 1, DELAYS.size - 2)
        slope = (shape.late[place + 1] - shape.late[place]) / (DELAYS[1] - DELAYS[0])
        late = shape.late[place] + (samples - DELAYS[place]) * slope
        return shape.seen - late, -slope / dt
    n = np.arange(1, len(shape.beside) + 1, dtype=np.float64)
    rate = 2.0 * np.pi * cycles.frequency * n
    cosine, sine = np.cos(rate * delay), np.sin(rate * delay)
    a, b = shape.seen.T
    ahead = np.stack([a * cosine + b * sine, b * cosine - a * sine], axis=1)
    slope = rate[:, None] * np.stack([ahead[:, 1], -ahead[:, 0]], axis=1)
    return ahead - shape.modelled, slope
