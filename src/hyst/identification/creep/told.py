"""What is told of creep: whether the records show it, how surely, and what drifts beside it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis import Diagnosis, Finding
from hyst.diagnosis.findings.drifting_output import NAME as DRIFT_FINDING
from hyst.diagnosis.wording import amount, percent
from hyst.errors import NotIdentifiableError
from hyst.identification.creep.evidence import Evidence
from hyst.identification.record_use.used_samples import Data
from hyst.identification.result.identified import Identified
from hyst.signals import Record

Array = NDArray[np.float64]

KNOWN = 0.02
"""Two standard errors of a weight, as a share of the output: more leaves it open."""

OF_THE_DECADES = 0.5
"""Share of the time constants from the fastest to a third of the record that must be known so."""

SLOW = 0.9
"""Of the longest record: a time constant beyond is not told from longer ones."""

SURE = 4.0
"""Standard errors that a drift beside creep must exceed."""

SMALLEST_DRIFT = 5e-4
"""Of the output's range: less harms nobody."""

LEAST_WEIGHT = 2.0
"""Standard errors that weights asked for must exceed to be told from none."""


@dataclass(frozen=True)
class DriftBeside:
    """The straight line in one record beside its creep.

    Parameters
    ----------
    number
        Of the record, counted from 1.
    total, error
        By how much the output drifts over the record, and the standard error, output units.
    """

    number: int
    total: float
    error: float


def is_known(seen: Evidence) -> bool:
    """Tell whether the records would have shown creep of some share of the output.

    Parameters
    ----------
    seen
        What was seen of creep.
    """
    at = seen.tau <= seen.tau[-1] / 3.0
    return not seen.resembled and bool(
        at.any() and np.mean(seen.limits[at] <= KNOWN) >= OF_THE_DECADES
    )


def sentence_without(seen: Evidence) -> str:
    """Say that no creep was found, and how much could have been there.

    Parameters
    ----------
    seen
        What was seen of creep.
    """
    if seen.shown:
        return (
            "the records show creep, but the fit with it did not converge, so no creep was taken; "
            "raise max_iterations, or ask for one lag (--creep 1)"
        )
    if seen.resembled:
        return (
            "what the model leaves looks like creep, but also like loops of another shape or "
            "dynamics, so no creep was taken; ask for it (--creep 1) where the actuator is known "
            "to creep, and record holds of the input at several levels"
        )
    if not is_known(seen):
        return (
            f"these records do not tell creep from drift: {_limits_in_words(seen)}; hold the input "
            "at several levels, each for as long as the slowest creep that matters"
        )
    at = seen.limits <= KNOWN
    return (
        f"no creep was found: a lag of {seen.tau[at][0]:.3g} to {seen.tau[at][-1]:.3g} s that adds "
        f"more than {percent(float(seen.limits[at].max()))} of the output would have been seen"
    )


def require_told(seen: Evidence) -> None:
    """Refuse records that leave open whether there is creep, where it was asked for.

    Parameters
    ----------
    seen
        What was seen of creep.

    Raises
    ------
    NotIdentifiableError
        With the numbers.
    """
    if seen.resembled or is_known(seen):
        return
    raise NotIdentifiableError(
        f"the records do not tell creep from drift and offset: {_limits_in_words(seen)}; record "
        "holds of the input at several levels, each for as long as the slowest creep that matters, "
        "or leave creep out"
    )


def _limits_in_words(seen: Evidence) -> str:
    middle, last = seen.tau.size // 2, int(np.argmin(np.abs(seen.tau - seen.tau[-1] / 3.0)))
    places = sorted({middle, last})
    known = [
        f"{percent(float(seen.limits[i]))} of the output with a time constant of "
        f"{seen.tau[i]:.3g} s"
        if seen.limits[i] < 1.0
        else f"all of the output with one of {seen.tau[i]:.3g} s"
        for i in places
    ]
    return f"a lag could add up to {' or '.join(known)} and go unseen"


def notes_on(identified: Identified, data: Data) -> tuple[str, ...]:
    """Say what makes weights and time constants no estimates.

    Parameters
    ----------
    identified
        With creep.
    data
        Its records.
    """
    weights, times = (_constants(identified, each) for each in ("weights", "time_constants"))
    longest = max(record.duration for record in data.records)
    notes = []
    for (weight, _), (tau, error) in zip(weights, times, strict=True):
        reach = tau if math.isnan(error) else tau + 2.0 * error
        if reach >= SLOW * longest:
            notes.append(
                f"creep with a time constant of {tau:.3g} s is not told from slower creep by "
                f"records of {longest:.3g} s: its weight of {weight:.3g} stands for all that is so "
                f"slow, and what comes after {longest:.3g} s at one level is an extrapolation"
            )
    for (weight, error), (tau, _) in zip(weights, times, strict=True):
        if error * LEAST_WEIGHT >= weight:
            notes.append(
                f"the lag of {tau:.3g} s adds {weight:.3g} +- {error:.2g} of the output, which is "
                "not told from none"
            )
    return tuple(notes)


def _constants(identified: Identified, name: str) -> list[tuple[float, float]]:
    rows = zip(
        identified.parameter_names,
        identified.parameter_values.tolist(),
        identified.standard_errors.tolist(),
        strict=True,
    )
    return [(value, error) for each, value, error in rows if each.startswith(f"creep.{name}[")]


def drift_beside(
    diagnosis: Diagnosis, records: Sequence[Record], drifts: Sequence[DriftBeside]
) -> Diagnosis:
    """Give a diagnosis that tells the drift beside creep in the place of what looked like drift.

    Parameters
    ----------
    diagnosis
        Made before creep was known of.
    records
        The records.
    drifts
        What drifts beside creep.
    """
    others = tuple(each for each in diagnosis.findings if each.name != DRIFT_FINDING)
    found = []
    for each in drifts:
        record = records[each.number - 1]
        span, unit = float(np.ptp(record.y)), record.output_unit
        if abs(each.total) < max(SURE * each.error, SMALLEST_DRIFT * span):
            continue
        rate = each.total / record.duration
        where = "" if len(records) == 1 else f"in record {each.number} "
        found.append(
            Finding(
                DRIFT_FINDING,
                "warning",
                f"{where}the output drifts beside its creep by {amount(rate, unit, 's')} and by "
                f"{amount(each.total, unit)} in all (+- {each.error:.2g}), "
                f"{percent(abs(each.total) / span)} of its range.",
                "It is fitted beside the model, which does not drift; the actuator does. Let it "
                "warm up or settle before it is recorded and used.",
                record=each.number,
                amounts={"rate": rate, "total": each.total, "total error": each.error},
            )
        )
    return replace(diagnosis, findings=(*found, *others))
