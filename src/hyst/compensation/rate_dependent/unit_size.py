"""A task in units in which its signals are about 1, by powers of two, which cost no bit.

What is solved there does not depend on the units of the model: scaled signals give the scaled
drive, bit for bit.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.compensation.rate_dependent.task import RateDependentTask
from hyst.models import RateDependentPrandtlIshlinskii
from hyst.models.rate_curve import RateCurve

Array = NDArray[np.float64]


def in_unit_size(task: RateDependentTask) -> tuple[RateDependentTask, float, float]:
    """Bring plays, target, state and range to about 1.

    Parameters
    ----------
    task
        In units of the model.

    Returns
    -------
    task : RateDependentTask
        Its plays alone: ``model``, ``before`` and ``start`` are those of the plays.
    by_input, by_output : float
        Powers of two: what the numbers of the drive and of the target were multiplied by.
    """
    plays = task.plays
    gain = plays.p0 + float(np.abs(plays.p).sum())
    a, b = _factor(task.target / gain), _factor(task.target)
    n = plays.p.size
    curve = plays.rate_curve
    # g(x) of the widening in new units at the rate in new units: a g(x / a).
    scaled = RateCurve(
        curve.beta,
        curve.powers / a ** np.arange(1, curve.powers.size + 1),
        curve.slopes,
        a * curve.knees,
    )
    new = RateDependentPrandtlIshlinskii(
        plays.p * (b / a), plays.r * a, scaled, plays.dt, plays.p0 * (b / a), plays.z0 * a
    )
    start = task.state()
    start[: n + 1] *= a
    return (
        replace(
            task, model=new, plays=new, before=None, start=start,
            plays_state=start, y_ref=task.target * b,
            target=task.target * b, low=task.low * a, high=task.high * a,
        ),
        a,
        b,
    )  # fmt: skip


def _factor(signal: Array) -> float:
    """Give the power of two that brings the largest number of a signal to between 1/2 and 1."""
    largest = float(np.abs(signal).max(initial=0.0))
    return math.ldexp(1.0, -math.frexp(largest)[1]) if largest > 0.0 else 1.0
