"""Codes among input and output of one record, where pulses of the drive are told from codes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.values.codes import Code, codes_in

Array = NDArray[np.float64]

_LEAST_JUMP = 0.02
_LAG = 10
_NEVER_AN_ANSWER = 1e9


def codes_of_record(u: Array, y: Array) -> tuple[tuple[Code, ...], tuple[Code, ...]]:
    """Give the codes of input and output; what comes right behind jumps of the input is none.

    Parameters
    ----------
    u, y
        Shape (N,), finite.
    """
    of_input = codes_in(u)
    of_output = codes_in(y)
    if of_output:
        drive = without_codes(u, of_input)
        of_output = tuple(each for each in of_output if not _is_answer(each, drive))
    return of_input, of_output


def without_codes(signal: Array, codes: tuple[Code, ...]) -> Array:
    """Give a signal with straight lines in the place of its codes."""
    if not codes:
        return signal
    return bridged(signal, np.unique(np.concatenate([each.samples for each in codes])))


def bridged(signal: Array, samples: NDArray[np.intp]) -> Array:
    """Give a signal with straight lines in the place of some samples."""
    if samples.size == 0:
        return signal
    good = np.ones(signal.size, dtype=bool)
    good[samples] = False
    places = np.flatnonzero(good)
    straight = signal.copy()
    straight[samples] = np.interp(samples, places, signal[places])
    return straight


def _is_answer(code: Code, u: Array) -> bool:
    """Whether an output far outside comes right behind jumps of the input, as of pulses."""
    moves = np.abs(np.diff(u, prepend=u[0]))
    jumps = moves > max(_LEAST_JUMP * float(np.ptp(u)), 6.0 * float(np.median(moves)))
    around = np.clip(code.samples[:, None] + np.arange(-_LAG, 1), 0, u.size - 1)
    return code.times_the_range < _NEVER_AN_ANSWER and bool(np.all(np.any(jumps[around], axis=1)))
