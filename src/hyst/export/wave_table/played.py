"""What a table does when it is played: a model's command for it, and its output."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.compensation import invert_trajectory
from hyst.errors import InputError
from hyst.operators import Operator

Array = NDArray[np.float64]

_FEW, _MOST = 3, 48  # periods after which a memory of plays, and any, has closed
_CLOSED = 1e-9  # of the range: what rounding leaves


@final
@dataclass(frozen=True)
class HeldError:
    """By how much something held from point to point is off what was wanted.

    Parameters
    ----------
    rms, max_abs
        At the points.
    held_rms, held_max_abs
        At all times, for it is held while what is wanted moves on in straight lines.
    """

    rms: float
    max_abs: float
    held_rms: float
    held_max_abs: float

    @classmethod
    def of(cls, given: Array, wanted: Array, repeat: bool) -> HeldError:
        """Give the error of points held against a signal that is wanted at the same points.

        Parameters
        ----------
        given, wanted
            At the points, shape (N,).
        repeat
            Whether the first point follows the last.
        """
        at_once = given - wanted
        later = given - np.append(wanted[1:], wanted[0] if repeat else wanted[-1])
        squares = (at_once**2 + at_once * later + later**2) / 3.0  # mean along a straight line
        return cls(
            math.sqrt(float(np.mean(at_once**2))),
            float(np.abs(at_once).max()),
            math.sqrt(float(np.mean(squares))),
            float(max(np.abs(at_once).max(), np.abs(later).max())),
        )


def command_of(
    model: Operator,
    y_ref: Array,
    limits: tuple[float, float],
    repeat: bool,
    history: list[float] | None,
    despite_verdict: bool,
) -> Array:
    """Give the exact command of a motion; of one that repeats that of its steady cycle.

    Parameters
    ----------
    model
        With an exact inverse.
    y_ref
        Wanted output, shape (N,).
    limits
        Lowest and highest drive.
    repeat
        Whether it goes on and on; the memory is then that of the cycles before.
    history
        Drive before the first sample.
    despite_verdict
        Whether an unfit model is used nevertheless.

    Raises
    ------
    InputError
        If the motion is out of reach, or no cycle is like the one before.
    NotInvertibleError
        If the model has no exact inverse.
    """
    periods = _FEW if repeat else 1
    while True:
        done = invert_trajectory(
            model,
            np.tile(y_ref, periods),
            input_range=limits,
            history=history,
            despite_verdict=despite_verdict,
        )
        u = done.u[-y_ref.size :]
        if not repeat:
            return u
        change = float(np.abs(u - done.u[-2 * y_ref.size : -y_ref.size]).max())
        if change <= _CLOSED * (limits[1] - limits[0]):
            return u
        if periods >= _MOST:
            raise InputError(
                f"after {periods} periods the command still changes by {change:.3g} from period to "
                "period, for the model's memory is slower than that; give one long record without "
                "repetition, or take the slow part out of the model"
            )
        periods *= 2


def output_of(
    model: Operator, u: Array, repeat: bool, history: list[float] | None
) -> tuple[Array, Array]:
    """Give the output in the first pass of a table, and in the steady cycle.

    Parameters
    ----------
    model
        Of the actuator.
    u
        The drive at the points, shape (N,).
    repeat
        Whether it goes on; else both are the same.
    history
        Drive before the first point.
    """
    state = model.initial_state()
    if history:
        state = model.run(history, state)[1]
    first, state = model.run(u, state)
    y, extent = first, float(np.ptp(first)) or 1.0
    for _ in range(_MOST if repeat else 0):
        before = y
        y, state = model.run(u, state)
        if float(np.abs(y - before).max()) <= _CLOSED * extent:
            break
    return first, y
