"""The verdict on a fit."""

from __future__ import annotations

from collections.abc import Mapping

from hyst.diagnosis import Diagnosis
from hyst.identification.families.family import Fit
from hyst.identification.record_use.used_samples import Data
from hyst.operators import Verdict
from hyst.signals import Metrics


def judge(data: Data, fit: Fit, diagnosis: Diagnosis, metrics: Mapping[str, Metrics]) -> Verdict:
    """Say how far a fit can be trusted, why, what it leaves, and what to do.

    Parameters
    ----------
    data
        The records as they were used.
    fit
        The final fit, in their units.
    diagnosis
        What the records showed before any model.
    metrics
        Errors by record, validation included.

    Returns
    -------
    Verdict
    """
    return Verdict("fair", ("The fit is not judged yet.",))
