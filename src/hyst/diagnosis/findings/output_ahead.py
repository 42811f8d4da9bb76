"""An output that turns before its input: channels not aligned, or a rate that it follows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from hyst.diagnosis.delay_evidence import DelayEvidence
from hyst.diagnosis.delay_of_records import delay_of
from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding

NAME = "output ahead of input"


def find(evidence: Evidence) -> Iterable[Finding]:
    """See ``told``."""
    found = delay_of(evidence)
    return () if found is None else told(found, evidence.records[0].dt)


def told(found: DelayEvidence, dt: float) -> Iterator[Finding]:
    """Warn where no delay, or no rate-independent model, can be right.

    Parameters
    ----------
    found
        On the records.
    dt
        Sample time of the first one, s.
    """
    said = found.said(dt)
    if found.excludes_zero and found.delay < 0.0:
        yield Finding(
            NAME,
            "warning",
            f"{said[0].upper()}{said[1:]}.",
            "Look for a filter, a trigger or a multiplexer that delays the input's channel alone; "
            f"give --delay {found.delay:.3g} to go on with the channels moved against each other.",
            amounts={"delay": found.delay, "low": found.low, "high": found.high},
        )
    elif found.turns_early:
        yield Finding(
            NAME,
            "warning",
            f"{said[0].upper()}{said[1:]}.",
            "A rate-independent model describes neither; compare records at several rates: what "
            "follows the rate grows with it, a misalignment stays the same in seconds.",
            amounts={"low": found.low, "high": found.high},
        )
