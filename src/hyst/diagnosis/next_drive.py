"""The drive that would add most to the records there are, and the command that writes it."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hyst.diagnosis.amplitudes import ranges_of
from hyst.diagnosis.evidence import Evidence
from hyst.signals import Drive, Record
from hyst.signals import design as design_drive

_LONGEST = 1e6  # samples
_SLOWER = 5.0
_FILE = "next.csv"


@dataclass(frozen=True)
class NextDrive:
    """A drive to record next.

    Parameters
    ----------
    reason
        What it would show that the records do not, one sentence.
    kind
        As of ``hyst excite``.
    rate
        Samples per second.
    amplitude, offset
        Input units.
    max_rate
        Input units per second.
    periods
        Cycles or curves.
    label
        Name and unit of the input.

    Examples
    --------
    >>> drive = NextDrive("minor loops", "forc", 100.0, 5.0, 5.0, 20.0, 4, "u [V]")
    >>> drive.command
    "hyst excite --kind forc --rate 100 --amplitude 5 --offset=5 --max-rate 20 --periods 4 \
--name 'u [V]' -o next.csv"
    """

    reason: str
    kind: str
    rate: float
    amplitude: float
    offset: float
    max_rate: float
    periods: int
    label: str

    @property
    def command(self) -> str:
        """The command that writes the drive, as a shell takes it."""
        numbers = [
            ["--rate", _number(self.rate)],
            ["--amplitude", _number(self.amplitude)],
            # An equals sign, for a value may begin with a minus.
            [f"--offset={_number(self.offset)}"],
            ["--max-rate", _number(self.max_rate)],
            ["--periods", str(self.periods)],
        ]
        words = [each for pair in numbers for each in pair]
        return shlex.join(
            ["hyst", "excite", "--kind", self.kind, *words, "--name", self.label, "-o", _FILE]
        )

    @cached_property
    def drive(self) -> Drive:
        """The drive itself, sample for sample what the command writes."""
        return design_drive(
            self.kind,
            dt=1.0 / self.rate,
            amplitude=self.amplitude,
            offset=self.offset,
            periods=self.periods,
            limits={"max_rate": self.max_rate},
        )


def next_drive(evidence: Evidence) -> NextDrive | None:
    """Choose what would add most: amplitudes, then repetition, then another rate; None for no data.

    Parameters
    ----------
    evidence
        The records.
    """
    records = list(evidence.numbered())
    if not records:
        return None
    spans = [float(np.ptp(record.u)) for _, record in records]
    _, record = records[int(np.argmax(spans))]
    if len(ranges_of([each.u for _, each in records])) <= 1:
        return _minor_loops(record)
    if all(evidence.repetition(which) is None for which, _ in records):
        reason = "the same loop three times shows how well the output repeats itself, and its drift"
        return _drive(record, reason, "triangle", _usual_rate(record), 3)
    rates = [_usual_rate(each) for _, each in records]
    if max(rates) < 2.0 * min(rates):
        return _slower(record, min(rates))
    reason = "another record of several amplitudes, which no fit has seen, judges a model"
    return _drive(record, reason, "reversals", _usual_rate(record), 8)


def _minor_loops(record: Record) -> NextDrive:
    reason = "loops of several amplitudes show what one amplitude leaves open, the minor loops"
    span = float(np.ptp(record.u))
    rests_below = record.u[0] < record.u.min() + 0.1 * span
    # From the lower end a drive need not jump to its middle.
    kind = "forc" if rests_below else "reversals"
    return _drive(record, reason, kind, _usual_rate(record), 8)


def _slower(record: Record, rate: float) -> NextDrive:
    reason = "the same range at another rate shows whether loops depend on it"
    samples = 4.0 * float(np.ptp(record.u)) / rate / record.dt
    slower = min(_SLOWER, max(_LONGEST / samples, 1.0))
    # Where a slower one would be too long, a faster one tells as much.
    changed = rate / slower if slower >= 2.0 else rate * 2.0
    return _drive(record, reason, "triangle", changed, 2)


def _drive(record: Record, reason: str, kind: str, rate: float, periods: int) -> NextDrive:
    low, high = float(record.u.min()), float(record.u.max())
    label = f"{record.input_name} [{record.input_unit}]" if record.input_unit else record.input_name
    return NextDrive(
        reason,
        kind,
        _rounded(record.rate, 12),
        _rounded(0.5 * (high - low), 6),
        _rounded(0.5 * (low + high), 6),
        _rounded(_fitting(record, rate, high - low), 4),
        periods,
        label,
    )


def _fitting(record: Record, rate: float, span: float) -> float:
    """Keep a drive between some samples and too many."""
    steps = 20.0 * span / record.dt
    return min(max(rate, steps / _LONGEST), steps / 400.0)


def _usual_rate(record: Record) -> float:
    """Median of ``|du/dt|`` while the drive moves, input units per second."""
    rates = np.abs(np.diff(record.u)) / record.dt
    return float(np.median(rates[rates > 0.02 * float(rates.max())]))


def _rounded(value: float, digits: int) -> float:
    return float(f"{value:.{digits}g}")


def _number(value: float) -> str:
    return f"{value:.12g}"
