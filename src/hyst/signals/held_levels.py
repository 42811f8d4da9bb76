"""Random levels, each held for some samples."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_number, as_positive, as_sample_time
from hyst.errors import InputError
from hyst.signals.drive import Drive, Limits, as_count, require_length
from hyst.signals.waypoints import path

Array = NDArray[np.float64]


def levels(
    dt: float,
    samples: int,
    amplitude: float,
    *,
    hold: int = 5,
    periods: int = 1,
    offset: float = 0.0,
    max_rate: float = math.inf,
    max_acceleration: float = math.inf,
    seed: int = 0,
) -> Drive:
    """Hold levels in random order, evenly spaced over ``offset +- amplitude``.

    Every level comes once a period, so that the values are spread evenly as far as the ramps
    between levels let them be.

    Parameters
    ----------
    dt
        Sample time, s.
    samples
        Of a period, at most; as many levels are held as fit in.
    amplitude
        Of the highest and the lowest level, input units.
    hold
        Samples at each level.
    periods
        How often the period is repeated.
    offset
        Middle of the levels, input units.
    max_rate, max_acceleration
        As of ``Limits``; levels are joined by ramps then.
    seed
        Of the order of the levels.

    Returns
    -------
    Drive

    Raises
    ------
    InputError
        If fewer than two levels fit in, or an argument cannot be used.

    Examples
    --------
    >>> drive = levels(1e-3, 12, 1.0, hold=3)
    >>> sorted(set(drive.u.round(9).tolist())), drive.period
    ([-1.0, -0.333333333, 0.333333333, 1.0], 12)
    """
    time, room = as_sample_time(dt), as_count(samples, "samples", 4)
    require_length(room * as_count(periods, "periods"))
    rest, half = as_count(hold, "hold"), as_positive(amplitude, "amplitude")
    if 2 * rest > room:
        raise InputError(
            f"hold is {rest} samples and a period has {room}, so not even two levels fit in; hold "
            "them shorter or give a longer duration"
        )
    limits = Limits(max_rate, max_acceleration)
    rng = np.random.default_rng(seed)
    if math.isinf(max_rate) and math.isinf(max_acceleration):
        heights = _shuffled(room // rest, rng)
        period = np.repeat(half * heights, rest)
        return Drive(np.tile(period, periods) + offset, time, "levels", period.size)
    if math.isinf(max_rate):  # an edge that ought to take no time takes one sample
        limits = Limits(4.0 * half / time, max_acceleration)
    if math.isfinite(max_acceleration):
        rest = max(rest, 2)  # a turn takes a sample at rest
    middle = as_number(offset, "offset")
    period, count = _with_ramps(room, (middle, half), rest, time, limits, rng)
    moving = 1.0 - count * rest / period.size
    notes = (f"{count} levels; ramps between them take {100.0 * moving:.0f} % of the time",)
    return Drive(np.tile(period, periods), time, "levels", period.size, notes)


def _shuffled(count: int, rng: np.random.Generator) -> Array:
    return rng.permutation(np.linspace(-1.0, 1.0, count))


def _with_ramps(
    room: int,
    span: tuple[float, float],
    hold: int,
    dt: float,
    limits: Limits,
    rng: np.random.Generator,
) -> tuple[Array, int]:
    """Give as many levels as fit into a period, joined by ramps, the last one with the first."""
    count, seed = room // hold, int(rng.integers(2**32))
    while count >= 2:
        heights = span[0] + span[1] * _shuffled(count, np.random.default_rng(seed))
        # The way back to the first level closes the period; the path rests hold samples on each.
        u = path(np.append(heights, heights[0]), dt, limits, hold - 1)
        period = u[: u.size - hold]
        if period.size <= room:
            return period, count
        count = min(count - 1, int(count * room / period.size))
    raise InputError(
        f"two levels held {hold} samples and the ramps between them are longer than a period of "
        f"{room} samples; give a longer duration, a lower amplitude or a higher max_rate"
    )
