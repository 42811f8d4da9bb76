"""Strokes of one amplitude, which leave open whether a loop is wide or late."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from hyst.diagnosis.delay_evidence import DelayEvidence
from hyst.diagnosis.delay_of_records import delay_of
from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding

NAME = "delay or radius"


def find(evidence: Evidence) -> Iterable[Finding]:
    """See ``told``."""
    found = delay_of(evidence)
    return () if found is None else told(found, evidence.records[0].dt)


def told(found: DelayEvidence, dt: float) -> Iterator[Finding]:
    """Remark on how much delay could hide in a loop of one amplitude.

    Parameters
    ----------
    found
        On the records.
    dt
        Sample time of the first one, s.
    """
    if not found.one_amplitude or not found.wide:
        return
    if not found.describes:
        yield Finding(
            NAME,
            "remark",
            "The strokes are of one amplitude and of loops of another kind than plays', by which "
            "nothing certain can be said of a delay.",
            "A record with a decaying amplitude, or of the same strokes at another rate, shows "
            "whether there is one.",
            amounts={"low": found.stated[0], "high": found.stated[1]},
        )
        return
    yield Finding(
        NAME,
        "remark",
        "The strokes are of one amplitude, by which a delay and a radius can hardly be told "
        f"apart: delays from {found.low * dt:.2g} to {found.high * dt:.2g} s "
        f"({found.low:.2g} to {found.high:.2g} samples) are possible.",
        "A record with a decaying amplitude, or of the same strokes at another rate, tells them "
        "apart: a delay is a time, a radius is none.",
        amounts={"low": found.low, "high": found.high},
    )
