"""Delay between input and output in whole samples."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.bounded_least_squares import minimize
from hyst.identification.data import Data
from hyst.identification.fitting import Fit, problem_of
from hyst.identification.play_bank import bank_matrix
from hyst.identification.thinning import thinned
from hyst.signals import reversals

Array = NDArray[np.float64]

PLAYS = 20
KNOTS = 9
STEPS_UPHILL = 3
MOST_ROWS = 20_000

WORTH_MOVING = 0.02
"""Share of the residual a delay must save to be preferred to the general estimate."""

REFIT_ITERATIONS = 6


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
    # Rows are left out evenly; the regressors of those that stay know the whole input.
    rows = slice(None, None, 1 + common.measured().size // MOST_ROWS)
    q = np.linalg.qr(_regressors(common)[rows])[0]
    best, least, uphill = 0, np.inf, 0
    for delay in range(longest + 1):
        y = _shifted_outputs(common, delay)[rows]
        y = y - y.mean()
        left = float(y @ y - np.square(q.T @ y).sum()) / float(y @ y)
        if left < least * (1.0 - 1e-9):
            best, least, uphill = delay, left, 0
        else:
            uphill += 1
        if uphill == STEPS_UPHILL:
            break
    return best


def refine_delay(data: Data, fit: Fit) -> int:
    """Judge the delay again by the family that was chosen.

    The general model of ``estimate_delay`` can mistake strong asymmetry for a little delay. From
    its delay on, smaller and larger ones are tried with the family's own constants fitted again,
    as long as the residual falls.

    Parameters
    ----------
    data
        The records with the delay found so far.
    fit
        The family fitted to them.

    Returns
    -------
    int
        The delay so far, or another one with which the family leaves at least ``WORTH_MOVING``
        less residual.
    """
    so_far = _mean_square(data, fit, data.delay)
    best, least = data.delay, so_far
    for step in (-1, 1):
        delay = data.delay + step
        while delay >= 0:
            error = _mean_square(data, fit, delay)
            if error >= least:
                break
            best, least, delay = delay, error, delay + step
    return best if least < (1.0 - WORTH_MOVING) ** 2 * so_far else data.delay


def _mean_square(data: Data, fit: Fit, delay: int) -> float:
    thin = thinned(data.delayed(delay))
    problem = problem_of(thin, fit.parametrization)
    solution = minimize(problem, fit.solution.theta, REFIT_ITERATIONS)
    return solution.cost / thin.measured().size


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
