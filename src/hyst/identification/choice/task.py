"""A family and the records it is fitted to, in units of its own."""

from __future__ import annotations

from dataclasses import dataclass, replace

from hyst.diagnosis.delay_evidence import DelayEvidence
from hyst.identification.families.family import Family
from hyst.identification.record_use.used_samples import Data


@dataclass(frozen=True, eq=False)
class Task:
    """A family, the records it uses, in powers of two of the user's units, and their scales.

    Parameters
    ----------
    family
        In the units of ``data``.
    given, data
        The records in the user's units, and in powers of two of them.
    scales
        Of input and output: ``given`` over ``data``.
    notes
        What was left out of the records, and why.
    evidence
        Of their delay; None where that was given, or is part of the model.
    """

    family: Family
    given: Data
    data: Data
    scales: tuple[float, float]
    notes: tuple[str, ...]
    evidence: DelayEvidence | None = None

    def delayed(self, delay: float, evidence: DelayEvidence | None) -> Task:
        """Give the same task with a delay.

        Parameters
        ----------
        delay
            Samples by which the output lags.
        evidence
            What is known of it.
        """
        given, data = self.given.delayed(delay), self.data.delayed(delay)
        return replace(self, given=given, data=data, evidence=evidence)

    def delay_is_unsure(self) -> bool:
        """Tell whether the records would also bear no delay."""
        return self.evidence is not None and self.data.lag != 0 and self.evidence.stated[0] <= 0.0

    def without_unsure_delay(self) -> Task:
        """Give the same task with no delay where the records would bear none."""
        if self.evidence is None or not self.delay_is_unsure():
            return self
        return self.delayed(0, self.evidence.undecided())

    def searched(self) -> Data:
        """Give what the search fits to."""
        return self.family.searched(self.data)
