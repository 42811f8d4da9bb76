"""Verdicts on records of which nothing is left out and nothing taken out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from hyst import Record
from hyst.diagnosis import Diagnosis, Finding
from hyst.identification.families.family import Family, Fit
from hyst.identification.identify_records import find
from hyst.identification.judgement.judge import judge
from hyst.identification.options import Options
from hyst.identification.progress import Progress
from hyst.identification.record_use.cleaned import Cleaned
from hyst.identification.record_use.used_samples import Data
from hyst.identification.result.identified_from_fit import metrics_by_record
from hyst.operators import Verdict
from hyst.signals import Metrics


def fitted_as_given(
    records: Record | Sequence[Record], family: Family
) -> tuple[Data, Fit, Mapping[str, Metrics]]:
    """Fit a family to every sample as it was measured."""
    given = (records,) if isinstance(records, Record) else tuple(records)
    nothing = (None,) * len(given)
    options = Options((), Progress(), 0, "auto", 200, True)
    found = find(Cleaned(given, nothing, nothing, nothing), [family], options)
    return found.data, found.fit, metrics_by_record(found.data, found.fit.operator, ())


def judged_as_given(
    records: Record | Sequence[Record], family: Family, findings: tuple[Finding, ...] = ()
) -> Verdict:
    """Judge such a fit; the diagnosis is what the test says it is."""
    data, fit, metrics = fitted_as_given(records, family)
    return judge(data, fit, Diagnosis(findings), metrics)
