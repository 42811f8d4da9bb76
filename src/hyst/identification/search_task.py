"""A family and the records it is fitted to, with the delay that was found in them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from hyst.diagnosis.delay_evidence import DelayEvidence
from hyst.identification.families.family import Family, Fit
from hyst.identification.fit.problem import model_output
from hyst.identification.record_use.used_samples import Data


@dataclass(frozen=True, eq=False)
class SearchTask:
    """A family, the records it uses, in powers of two of the user's units, and their scales.

    Parameters
    ----------
    family
        In the units of ``data``.
    given
        The records.
    data
        The same in powers of two of their units.
    scales
        Those powers, of input and output.
    notes
        Sentences about what was left out.
    evidence
        What the records say of their delay; None where it was given.
    """

    family: Family
    given: Data
    data: Data
    scales: tuple[float, float]
    notes: tuple[str, ...]
    evidence: DelayEvidence | None = None

    def delayed(self, delay: float, evidence: DelayEvidence | None) -> SearchTask:
        """Give the same task with a delay.

        Parameters
        ----------
        delay
            Samples.
        evidence
            What it is known by.
        """
        given, data = self.given.delayed(delay), self.data.delayed(delay)
        return replace(self, given=given, data=data, evidence=evidence)

    def delay_is_unsure(self) -> bool:
        """Tell whether the records would also bear no delay."""
        return self.evidence is not None and self.data.lag != 0 and self.evidence.stated[0] <= 0.0

    def without_unsure_delay(self) -> SearchTask:
        """Give the same task with no delay where the records would bear none."""
        if self.evidence is None or not self.delay_is_unsure():
            return self
        return self.delayed(0, self.evidence.undecided())

    def searched(self) -> Data:
        """Give what the search fits to."""
        return self.family.searched(self.data)


def rms_left(data: Data, fit: Fit) -> float:
    """Give the root mean square of what a fit leaves of records, in their units.

    Parameters
    ----------
    data
        The records.
    fit
        Its operator is run over them.
    """
    error = model_output(data, fit.operator) - data.measured()
    return float(np.sqrt(np.mean(np.square(error))))
