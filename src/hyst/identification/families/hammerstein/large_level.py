"""Outputs far from 0: the fit is of what is left beside their level.

Dynamics answer an offset before them with a step that is as large as the offset, and every change
of their constants moves that step. Where it is a hundred times the record, nothing else is seen.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hyst.errors import NotIdentifiableError
from hyst.identification.families.family import Fit
from hyst.identification.families.hammerstein.joint import joint_of
from hyst.identification.families.hammerstein.told.identified_hammerstein import (
    IdentifiedHammerstein,
)
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.record_use.used_samples import Data, beside_level

_LARGE = 1.0  # times the range of the output: it does not come near 0


def without_large_level(data: Data) -> Data:
    """Give the records without the mean of their outputs where that is beyond their ranges.

    Parameters
    ----------
    data
        The records.
    """
    level = float(np.mean([each.y.mean() for each in data.records]))
    span = max(float(np.ptp(each.y)) for each in data.records)
    if abs(level) <= _LARGE * span:
        return data
    records = tuple(beside_level(data.records, replace(data, level=level)))
    return replace(data, records=records, level=level)


def told_of_level(data: Data) -> tuple[str, ...]:
    """Say that errors are those beside a level.

    Parameters
    ----------
    data
        The records.
    """
    if not data.level:
        return ()
    return (
        f"the output is about {data.level:.6g}, far from 0 beside its range: the errors are those "
        "beside that level, at rest before; a model that is run from a state of 0 takes as long to "
        "come to it as its dynamics to settle",
    )


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


def at_level(found: IdentifiedHammerstein, fit: Fit, level: float) -> IdentifiedHammerstein:
    """Give a result beside a level as one of the records as they were measured.

    Parameters
    ----------
    found
        The result.
    fit
        With the offset.
    level
        Output units.
    """
    about = found.description
    ends = (about.output_low, about.output_high)
    low, high = (None if each is None else each + level for each in ends)
    values = found.parameter_values.copy()
    constants = joint_of(fit).front.template.parameters().names
    values[found.parameter_names.index(constants[-1])] += level
    return replace(
        found,
        model=fit.operator,
        hysteresis=joint_of(fit).hysteresis(fit.solution.theta),
        parameter_values=values,
        loop=replace(found.loop, v=found.loop.v + level),
        description=replace(about, output_low=low, output_high=high),
    )
