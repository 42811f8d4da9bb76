"""Which record would add most, and how to make its drive."""

from __future__ import annotations

from collections.abc import Iterator

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.next_drive import next_drive

NAME = "next record"


def find(evidence: Evidence) -> Iterator[Finding]:
    """Propose the drive of the next record, as a command that writes it."""
    chosen = evidence.once("next drive", lambda: next_drive(evidence))
    if chosen is not None:
        yield Finding(
            NAME,
            "remark",
            f"{chosen.reason}.",
            f"Record it by: {chosen.command} (it starts at {chosen.drive.u[0]:.4g}: go there "
            "slowly, and check that your amplifier may).",
        )
