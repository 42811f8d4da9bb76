"""What was driven: levels, amplitudes, rates, period."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hyst.diagnosis.amplitudes import Amplitudes, amplitudes_of
from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.wording import amount, counted, of_record
from hyst.signals import Record

NAME = "drive"


def find(evidence: Evidence) -> Iterator[Finding]:
    """Say for every record between which levels, how often and how fast it was driven."""
    for number, record in evidence.numbered():
        found = amplitudes_of(record.u)
        yield _told(evidence, number, record, found)


def _told(evidence: Evidence, number: int, record: Record, found: Amplitudes) -> Finding:
    unit, ranges = record.input_unit, len(found.ranges)
    low, high = float(record.u.min()), float(record.u.max())
    rates = np.abs(np.diff(record.u)) / record.dt
    moving = rates[rates > 0.02 * float(rates.max())]
    slow, fast = (float(each) for each in np.percentile(moving, [5.0, 95.0]))
    sentence = (
        f"{of_record(evidence, number)}the input runs from {amount(low, '')} to "
        f"{amount(high, unit)} with {counted(found.turns, 'reversal')} at "
        f"{counted(found.levels, 'level')} ({counted(ranges, 'range')}"
        f"{', one within another' if found.nested else ''}), at "
        + (
            f"{amount(fast, unit, 's')}"
            if slow > 0.9 * fast
            else f"{amount(slow, '')} to {amount(fast, unit, 's')}"
        )
    )
    amounts = {
        "low": low,
        "high": high,
        "reversals": float(found.turns),
        "levels": float(found.levels),
        "ranges": float(ranges),
        "slowest": slow,
        "fastest": fast,
    }
    repetition = evidence.repetition(number)
    if repetition is not None and repetition.period > 0.0:
        period = repetition.period * record.dt
        amounts |= {"frequency": 1.0 / period, "samples per period": repetition.period}
        sentence += (
            f"; it repeats after {amount(period, 's')} ({1.0 / period:.4g} Hz, "
            f"{repetition.period:.6g} samples), {repetition.periods:.3g} settled periods"
        )
    return Finding(NAME, "remark", f"{sentence}.", record=number, amounts=amounts)
