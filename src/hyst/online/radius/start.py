"""Estimators of radii from a model, with gains that suit a record."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.errors import InputError
from hyst.online.joint.parts import take_apart
from hyst.online.radius.radius_estimator import RadiusEstimator
from hyst.operators import Operator
from hyst.signals import Record

Array = NDArray[np.float64]

# Share of an error that the gradient takes back in a sample; the paper's 10 per second make 0.011.
_SHARE = 0.01
_QUIET = 1e-3


def radius_estimator_for(
    model: Operator,
    dt: float,
    gain: ArrayLike | None = None,
    *,
    record: Record | None = None,
    **options: Any,
) -> RadiusEstimator:
    """Make the estimator of a model's radii, whose weights and offset are known.

    Parameters
    ----------
    model
        Plays, at most with a gain and an offset behind them.
    dt
        Sample time, seconds.
    gain
        As of ``RadiusEstimator``; for the gradient, left out, one that takes back a hundredth of an
        error in a sample, as the paper's does.
    record
        For least squares without a gain: what it will learn from, whose ranges tell a gain.
    options
        More of ``RadiusEstimator``.

    Returns
    -------
    RadiusEstimator

    Raises
    ------
    InputError
        If the model has other stages or a negative weight, or options do not fit.

    Examples
    --------
    >>> import hyst
    >>> estimator = radius_estimator_for(hyst.PrandtlIshlinskii([0.5], [1.0], 1.0), 0.001)
    >>> estimator.names, estimator.settings["gain"]
    (('r[1]',), [40.0])
    """
    parts = take_apart(model)
    stages = {"a map or gain before": parts.before or parts.front, "a map behind": parts.back}
    for what, stage in stages.items():
        if stage is not None:
            raise InputError(
                f"the law reads the slopes of plays alone, but the model has {what} them; adapt it "
                "without the law"
            )
    p, p0 = parts.after.gain * parts.pi.p, parts.after.gain * parts.pi.p0
    if gain is None:
        if options.get("method") != "least-squares":
            square = float(p @ p)
            gain = _SHARE / (dt * square) if square > 0.0 else 0.0
        elif record is not None:
            gain = _variance_for(parts.pi.r, record)
        else:
            raise InputError("gain is left out; give the variance of the start over the noise's")
    found = RadiusEstimator(
        p, parts.pi.r, gain, dt, p0=p0, z0=parts.pi.z0, offset=parts.after.offset, **options
    )
    found.description = model.description
    return found


def _variance_for(r: Array, record: Record) -> float:
    """Give the gain of least squares for a start that is a guess.

    The largest radius, or half the range of the input if that is 0, is taken for its standard
    error, and a thousandth of the output's range for the noise's.
    """
    largest = float(r[-1]) if r.size and r[-1] > 0.0 else 0.5 * float(np.ptp(record.u))
    quiet = _QUIET * float(np.ptp(record.y))
    if not quiet > 0.0:
        raise InputError("the output of the record rests, so nothing can be learnt")
    return (largest / quiet) ** 2
