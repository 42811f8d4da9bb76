"""Delay between input and output in whole samples."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.data import Data
from hyst.identification.play_bank import bank_matrix
from hyst.signals import reversals

Array = NDArray[np.float64]

PLAYS = 20
KNOTS = 9
STEPS_UPHILL = 3


def estimate_delay(data: Data) -> int:
    """Find the delay that leaves the least residual of a model richer than any family.

    The regressors are the input, evenly spaced plays, dead-zone functions of the input and of one
    play's output (so that asymmetry does not pass for delay), and a linear drift. They do not
    depend on the delay, so one QR factorisation serves all; delays are tried upwards from 0 until
    the residual has grown three times in a row. A rate-independent loop turns with its input, a
    delayed one after it, which is what tells hysteresis and delay apart.

    Parameters
    ----------
    data
        The records; their own delay is ignored.

    Returns
    -------
    int
        Samples, at least 0 and at most a quarter of the shortest usual stroke.
    """
    longest = min(_longest_delay(record.u) for record in data.records)
    if longest == 0:
        return 0
    common = data.delayed(longest)
    q = np.linalg.qr(_regressors(common))[0]
    best, least, uphill = 0, np.inf, 0
    for delay in range(longest + 1):
        y = _shifted_outputs(common, delay)
        y = y - y.mean()
        left = float(y @ y - np.square(q.T @ y).sum()) / float(y @ y)
        if left < least * (1.0 - 1e-9):
            best, least, uphill = delay, left, 0
        else:
            uphill += 1
        if uphill == STEPS_UPHILL:
            break
    return best


def _longest_delay(u: Array) -> int:
    turns = reversals(u, 0.05 * float(np.ptp(u)))
    stroke = float(np.median(np.diff(turns))) if turns.size > 1 else float(u.size)
    return int(min(stroke / 4.0, u.size / 20.0))


def _shifted_outputs(data: Data, delay: int) -> Array:
    return np.concatenate(
        [
            record.y[window.start + delay : window.stop + delay]
            for record, window in zip(data.records, data.windows(), strict=True)
        ]
    )


def _regressors(data: Data) -> Array:
    r = data.half_range * np.arange(1, PLAYS + 1) / (PLAYS + 1)
    bank = bank_matrix(data, r)
    ramps = [_ramps(bank[:, 0]), _ramps(bank[:, 1 + PLAYS // 3])]
    drift = np.linspace(-1.0, 1.0, len(bank))
    matrix = np.column_stack([bank, *ramps, drift])
    matrix = matrix - matrix.mean(axis=0)
    spread = matrix.std(axis=0)
    moving = spread > 1e-9 * spread.max()
    return np.ascontiguousarray(matrix[:, moving] / spread[moving])


def _ramps(signal: Array) -> Array:
    knots = np.linspace(signal.min(), signal.max(), KNOTS + 2)[1:-1]
    return np.maximum(signal[:, None] - knots, 0.0)
