"""Put a lag before the hysteresis of a fit, and before the drive of records."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from hyst.identification.families.family import Fit
from hyst.identification.fit.stages import with_stage
from hyst.identification.lag.lagging_family import LaggingFamily
from hyst.identification.record_use.cleaned import Cleaned
from hyst.models import Lag

LONGEST = 20.0
"""Of a time constant that is looked for: times what was seen first."""

SHORTEST = 1e-3
"""Samples: of one that is looked for."""


def lagged(records: Cleaned, time_constant: float) -> Cleaned:
    """Give records whose drive is what comes out of a lag.

    Parameters
    ----------
    records
        Their drive as it was given to the lag.
    time_constant
        Of the lag, s.
    """
    late = [replace(each, u=Lag(time_constant, each.dt)(each.u)) for each in records.records]
    return replace(records, records=tuple(late))


def lagging(
    fit: Fit, dt: float, time_constant: float, held: bool = False, longest: float = math.inf
) -> Fit:
    """Put a lag before the first stage of a fit.

    Parameters
    ----------
    fit
        Without a lag.
    dt
        Sample time of its first record, s.
    time_constant
        Of the lag, s; where it is not held, where the search starts.
    held
        Whether it keeps that.
    longest
        It may come to, s.
    """
    values = np.array([time_constant])
    lower, upper = (values, values) if held else (np.array([SHORTEST * dt]), np.array([longest]))
    parametrization, theta = with_stage(
        fit.parametrization,
        fit.solution.theta,
        Lag(time_constant, dt),
        "drive",
        lower,
        np.minimum(upper, 1e6 * dt),
    )
    solution = replace(fit.solution, theta=theta)
    return Fit(LaggingFamily(fit.family), fit.size, parametrization, solution)
