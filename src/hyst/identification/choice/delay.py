"""Delay between input and output in whole samples."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Fit
from hyst.identification.fit.play_bank import bank_matrix
from hyst.identification.record_use.thinning import thinned
from hyst.identification.record_use.used_samples import Data
from hyst.signals import reversals

Array = NDArray[np.float64]

PLAYS = 20
KNOTS = 9
STEPS_UPHILL = 3
MOST_ROWS = 20_000

WORTH_MOVING = 0.02
"""Residuals (rms) that differ by less than this share are taken for equal."""

REFIT_ITERATIONS = 10


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
        Samples, at least 0 and at most a quarter of the shortest usual stroke, or half of what of
        the shortest record is used.
    """
    longest = min(_half_of_used(data), *(_longest_delay(record.u) for record in data.records))
    if longest == 0:
        return 0
    general = _GeneralModel.of(data.delayed(longest))
    best, least, uphill = 0, np.inf, 0
    for delay in range(longest + 1):
        left = general.mean_square(delay)
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
        Where the family describes the records as well as the general model, the delay it likes
        best; otherwise the delay so far, unless the family leaves ``WORTH_MOVING`` less residual
        with another one.
    """
    so_far = _mean_square(data, fit, data.delay)
    general = _GeneralModel.of(data).mean_square(data.delay)
    best, least = data.delay, so_far
    most = _half_of_used(data)
    for step in (-1, 1):
        delay = data.delay + step
        while 0 <= delay <= most:
            error = _mean_square(data, fit, delay)
            if error >= least:
                break
            best, least, delay = delay, error, delay + step
    as_good_as_general = least < (1.0 + WORTH_MOVING) ** 2 * general
    better_by_far = least < (1.0 - WORTH_MOVING) ** 2 * so_far
    return best if as_good_as_general or better_by_far else data.delay


def _mean_square(data: Data, fit: Fit, delay: int) -> float:
    """Fit the family to thinned records, but judge it by all samples.

    Thinned records hold other samples of the noise at every delay, which would decide.
    """
    shifted = data.delayed(delay)
    searched = shifted if fit.family.depends_on_rate else thinned(shifted)
    theta = fit.family.solve(fit.problem(searched), fit.solution.theta, REFIT_ITERATIONS).theta
    residual = fit.problem(shifted).residual(theta)
    return float(residual @ residual) / residual.size


def _half_of_used(data: Data) -> int:
    """Give half the samples used of the shortest record: a longer delay would leave too few."""
    return min(len(r) - s for r, s in zip(data.records, data.starts, strict=True)) // 2


def _longest_delay(u: Array) -> int:
    turns = reversals(u, 0.05 * float(np.ptp(u)))
    stroke = float(np.median(np.diff(turns))) if turns.size > 1 else float(u.size)
    return int(min(stroke / 4.0, u.size / 20.0))


@dataclass(frozen=True, eq=False)
class _GeneralModel:
    """The regressors of the general model, orthonormal, on some of the samples.

    Samples are left out evenly; the regressors of those that stay know the whole input.
    """

    data: Data
    rows: slice
    q: Array

    @classmethod
    def of(cls, data: Data) -> _GeneralModel:
        rows = slice(None, None, 1 + data.measured().size // MOST_ROWS)
        return cls(data, rows, np.linalg.qr(_regressors(data)[rows])[0])

    def mean_square(self, delay: int) -> float:
        """Give the mean square this model leaves of the output ``delay`` samples later."""
        y = _shifted_outputs(self.data, delay)[self.rows]
        y = y - y.mean()
        explained: Array = self.q.T @ y
        left: float = float(y @ y) - float(explained @ explained)
        return left / float(y.size)


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
    drift = data.half_range * np.linspace(-1.0, 1.0, len(bank))
    matrix = np.column_stack([bank, *ramps, drift])
    matrix = matrix - matrix.mean(axis=0)
    spread = matrix.std(axis=0)
    moving = spread > 1e-9 * spread.max()
    return np.ascontiguousarray(matrix[:, moving] / spread[moving])


def _ramps(signal: Array) -> Array:
    knots = np.linspace(signal.min(), signal.max(), KNOTS + 2)[1:-1]
    return np.maximum(signal[:, None] - knots, 0.0)
