"""Outputs far from 0: the fit is of what is left beside their level.

Dynamics answer an offset before them with a step that is as large as the offset, and every change
of their constants moves that step. Where it is a hundred times the record, nothing else is seen.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hyst.errors import NotIdentifiableError
from hyst.identification.families.family import Fit
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.record_use.used_samples import Data

_LARGE = 2.0  # times the range of the output


def without_large_level(data: Data) -> Data:
    """Give the records without the mean of their outputs where that is beyond their ranges.

    Parameters
    ----------
    data
        The records.
    """
    level = float(np.mean([each.y.mean() for each in data.records]))
    span = max(float(np.ptp(each.y)) for each in data.records)
    return data.without_level(level) if abs(level) > _LARGE * span else data


def raised_by(fit: Fit, front: Parametrization, level: float) -> Fit:
    """Give a fit whose hysteresis has so much more offset.

    Parameters
    ----------
    fit
        Of hysteresis and dynamics.
    front
        The free parameters of the hysteresis; its offset is its last constant.
    level
        Output units.

    Raises
    ------
    NotIdentifiableError
        If the hysteresis has no free offset.
    """
    row = front.transform[-1]
    places = np.flatnonzero(row)
    named = front.template.parameters().names[-1].endswith("offset")
    if not named or places.size != 1 or np.count_nonzero(front.transform[:, places[0]]) != 1:
        raise NotIdentifiableError(
            f"the output is about {level:.6g}, far from 0 beside its range, and this hysteresis "
            "has no offset; take the offset out of the output"
        )
    theta = fit.solution.theta.copy()
    theta[places[0]] += level / row[places[0]]
    return replace(fit, solution=replace(fit.solution, theta=theta))
