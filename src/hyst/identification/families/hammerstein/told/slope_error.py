"""How well the slope of a hysteresis is known, which an exact inverse then misses by as much."""

from __future__ import annotations

import numpy as np

from hyst.identification.families.family import Fit
from hyst.identification.families.hammerstein.joint import joint_of
from hyst.identification.record_use.used_samples import Data
from hyst.identification.result.fit_spread import FitSpread

_MOST_SAMPLES, _MOST_SLOPES = 20_000, 300
_MOVING = 0.3  # of the largest step of the drive: slopes of smaller ones are rounding


def slope_error_of(fit: Fit, data: Data, spread: FitSpread) -> float | None:
    """Give the largest relative standard error of the slope dv/du over the records' widest drive.

    ``(dv_{k+1}/dtheta - dv_k/dtheta) / (v_{k+1} - v_k)`` is the derivative of the logarithm of a
    slope, whose standard error follows from the covariance of the fit.

    Parameters
    ----------
    fit
        The final fit of hysteresis and dynamics, in units of the records.
    data
        The records.
    spread
        How sure its free parameters are.

    Returns
    -------
    float or None
        None where a slope is 0, or the records do not determine it; 0 of a hysteresis that was
        given.
    """
    parametrization, theta = joint_of(fit), fit.solution.theta
    hysteresis = parametrization.hysteresis(theta)
    u = max((each.u for each in data.records), key=np.ptp)[:_MOST_SAMPLES]
    by_theta = hysteresis.jacobian(u) @ parametrization.transform[: len(hysteresis.parameters())]
    step, rise = np.diff(u), np.diff(hysteresis(u))
    moving = np.flatnonzero(np.abs(step) > _MOVING * np.abs(step).max(initial=0.0))
    moving = moving[:: max(moving.size // _MOST_SLOPES, 1)]
    if not moving.size or not np.all(rise[moving] != 0.0):
        return None
    rows = np.diff(by_theta, axis=0)[moving] / rise[moving, None]
    rows = rows[rows.any(axis=1)]
    if not len(rows):
        return 0.0
    largest = float(np.max(spread.of(rows)))
    return largest if np.isfinite(largest) else None
