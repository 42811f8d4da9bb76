"""What records can tell, before any model."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst._above import PAGES, above
from hyst.diagnosis.delay_evidence import DelayEvidence
from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import NO_SAMPLES, SEVERITIES, Finding, Severity
from hyst.diagnosis.findings import delay_or_radius, output_ahead
from hyst.diagnosis.next_drive import NextDrive, next_drive
from hyst.diagnosis.registry import FINDERS, FINDERS_OF_DELAY, Finder
from hyst.errors import InputError
from hyst.signals import Record


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """What was found in records, the worst first.

    Parameters
    ----------
    findings
        Each with a name, a severity, a sentence and advice.
    next_drive
        The drive that would add most, with ``.command`` and ``.drive``; None where nothing moves.
    """

    findings: tuple[Finding, ...]
    next_drive: NextDrive | None = None

    def of(self, severity: Severity) -> tuple[Finding, ...]:
        """Give the findings of one severity.

        Parameters
        ----------
        severity
            One of those a finding may have.
        """
        return tuple(each for each in self.findings if each.severity == severity)

    def named(self, name: str) -> tuple[Finding, ...]:
        """Give the findings of one name.

        Parameters
        ----------
        name
            In the registry of findings.
        """
        return tuple(each for each in self.findings if each.name == name)

    def left_out(self, record: int) -> NDArray[np.intp]:
        """Give the samples of a record that are no measurements, ascending.

        Parameters
        ----------
        record
            Which, counted from 1.
        """
        parts = [each.samples for each in self.of("left out") if each.record == record]
        return np.unique(np.concatenate([NO_SAMPLES, *parts]))

    def with_delay(self, found: DelayEvidence, dt: float) -> Diagnosis:
        """Give the same diagnosis with what there is to say of a delay.

        Parameters
        ----------
        found
            On the same records.
        dt
            Sample time of the first one, s.
        """
        more = (*output_ahead.told(found, dt), *delay_or_radius.told(found, dt))
        return replace(self, findings=_worst_first((*self.findings, *more)))

    def summary(self) -> str:
        """Give all sentences, one paragraph for each severity, for people.

        Returns
        -------
        str
        """
        lines = []
        for severity in SEVERITIES:
            found = self.of(severity)
            if not found:
                continue
            lines.append(f"{severity}:")
            for each in found:
                advice = f" {each.advice}" if each.advice else ""
                lines.append(f"  {each.name}: {each.sentence}{advice}")
        return "\n".join(lines)

    def to_dict(self) -> dict[str, Any]:
        """Give everything as plain numbers and text."""
        return {
            "findings": [each.to_dict() for each in self.findings],
            "next_drive": None if self.next_drive is None else self.next_drive.command,
        }

    def _repr_html_(self) -> str:
        return str(above(PAGES, "page_of_diagnosis")(self))


def diagnose(records: Record | Sequence[Record]) -> Diagnosis:
    """Say what records of one actuator can tell and what they cannot, before any model.

    Parameters
    ----------
    records
        One or more.

    Returns
    -------
    Diagnosis
        ``.findings``, each with ``.name``, ``.severity``, ``.sentence`` and ``.advice``, the worst
        first; ``.summary()`` for people.

    Raises
    ------
    InputError
        If there is no record, or something is none.

    Examples
    --------
    >>> import numpy as np, hyst
    >>> u = np.sin(np.linspace(0.0, 20.0, 2000))
    >>> found = hyst.diagnose(hyst.Record(u, 2.0 * u, dt=1e-3))
    >>> found.of("refusal")
    ()
    """
    given = (records,) if isinstance(records, Record) else tuple(records)
    for number, record in enumerate(given, 1):
        if not isinstance(record, Record):
            raise InputError(f"record {number} is {type(record).__name__}; give a hyst.Record")
    return _found(given, FINDERS + FINDERS_OF_DELAY)


def diagnose_all_but_delay(records: Sequence[Record]) -> Diagnosis:
    """Diagnose records for who will look for their delay anyway, which costs as much as the rest.

    Parameters
    ----------
    records
        One or more.

    Raises
    ------
    InputError
        If there is none.
    """
    return _found(tuple(records), FINDERS)


def _found(records: tuple[Record, ...], finders: Sequence[Finder]) -> Diagnosis:
    if not records:
        raise InputError("there is no record; give at least one")
    evidence = Evidence(records)
    found: list[Finding] = []
    for find in finders:
        new = tuple(find(evidence))
        evidence.tell(new)
        found += new
    drive = evidence.once("next drive", lambda: next_drive(evidence))
    return Diagnosis(_worst_first(found), drive)


def _worst_first(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    return tuple(sorted(findings, key=lambda each: SEVERITIES.index(each.severity)))
