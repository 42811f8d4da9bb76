"""Sines in the output that are not the drive's: mains hum, a fan, a vibration."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.memory_branches import turns_of
from hyst.diagnosis.repetition import Repetition, changes
from hyst.diagnosis.spectral_lines import Line, lines_of
from hyst.diagnosis.wording import amount, of_record, percent
from hyst.signals import Record

Array = NDArray[np.float64]

NAME = "foreign line"
_LEAST = 3e-4  # of the range of the output
_LEAST_OF_NOISE = 0.5
# Samples of a branch and degree of what is taken out of it: lines of half as many cycles stay.
_FEWEST_SAMPLES, _DEGREE = 40, 9
_MOST_BRANCHES = 400
_LONGEST = 1 << 17
_MAINS = (50.0, 60.0)
# A harmonic of the drive has neighbours of its size; a line has none (amplitudes).
_OVER_HARMONICS = 4.0


def find(evidence: Evidence) -> Iterator[Finding]:
    """Warn of sines that stand out of the output, also where they stand still against the drive."""
    for number, record in evidence.numbered():
        span = float(np.ptp(record.y))
        least = max(_LEAST * span, _LEAST_OF_NOISE * (evidence.noise(number) or 0.0))
        for line in _lines(record, evidence.repetition(number)):
            if line.amplitude < least:
                continue
            yield Finding(
                NAME,
                "warning",
                f"{of_record(evidence, number)}the output holds a sine of "
                f"{line.frequency:.4g} Hz with an amplitude of "
                f"{amount(line.amplitude, record.output_unit)} ({percent(line.amplitude / span)} "
                f"of its range) that the drive does not ask for{_mains(line, record)}.",
                "A model that is given plays enough draws it as hysteresis. Remove its source or "
                "filter input and output alike, and record again.",
                record=number,
                amounts={"frequency": line.frequency, "amplitude": line.amplitude},
            )


def _mains(line: Line, record: Record) -> str:
    for base in _MAINS:
        times = round(line.frequency / base)
        if times >= 1 and abs(line.frequency - times * base) < max(
            0.002 * line.frequency, 0.3 / record.duration
        ):
            return f": the mains of {base:.0f} Hz" + (f", {times} times" if times > 1 else "")
    return ""


def _lines(record: Record, repetition: Repetition | None) -> list[Line]:
    """Lines of what repeats with a sign of its own, and of branches less what is smooth in them."""
    record = record.slice(0, min(record.samples, _LONGEST))
    found = _between_repeats(record, repetition) + _within_branches(record)
    found.sort(key=lambda line: -line.amplitude)
    kept: list[Line] = []
    for line in found:
        if all(abs(line.frequency - each.frequency) > 2.0 / record.duration for each in kept):
            kept.append(line)
    return kept


def _between_repeats(record: Record, repetition: Repetition | None) -> list[Line]:
    """Lines of the change from one period to the next, in which the drive's own have no part."""
    if repetition is None or repetition.period == 0.0:
        return []
    start, stop, lag = max(repetition.segments, key=lambda each: each[1] - each[0])
    stop = min(stop, record.samples)
    if stop - start < 64:
        return []
    of_u, of_y, _ = changes(record, start, stop, lag)
    found = []
    driven = lines_of(of_u, record.dt)
    for line in lines_of(of_y, record.dt):
        # A sine and itself a lag ago: what is left of it depends on its phase over the lag.
        left = 2.0 * abs(np.sin(np.pi * line.frequency * lag * record.dt))
        if left > 0.3 and not _in(driven, line, record):
            found.append(Line(line.frequency, line.amplitude / float(left)))
    return found


def _within_branches(record: Record) -> list[Line]:
    turns = turns_of(record.u)
    ends = np.concatenate([[0], turns, [record.samples]])
    lengths = np.diff(ends)
    usual = float(np.median(lengths))
    if usual < _FEWEST_SAMPLES or lengths.size > _MOST_BRANCHES:
        return []
    rest = _without_smooth(record.y, ends)
    drive = lines_of(_without_smooth(record.u, ends), record.dt)
    found = []
    for line in lines_of(rest, record.dt):
        enough_cycles = line.frequency * usual * record.dt > 0.5 * _DEGREE
        if enough_cycles and not _in(drive, line, record) and _alone(rest, line, record.dt, usual):
            found.append(line)
    return found


def _in(lines: tuple[Line, ...], line: Line, record: Record) -> bool:
    return any(abs(each.frequency - line.frequency) < 2.0 / record.duration for each in lines)


def _without_smooth(signal: Array, ends: NDArray[np.intp]) -> Array:
    """Take a polynomial in time out of every branch."""
    rest = np.zeros_like(signal)
    for start, stop in zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True):
        degree = min(_DEGREE, (stop - start) // 6)
        if stop - start < _DEGREE:
            continue
        basis = _basis(stop - start, degree)
        part = signal[start:stop]
        rest[start:stop] = part - basis @ (basis.T @ part)
    return rest


def _basis(samples: int, degree: int) -> Array:
    t = np.linspace(-1.0, 1.0, samples)
    return np.linalg.qr(np.polynomial.legendre.legvander(t, degree))[0]


def _alone(rest: Array, line: Line, dt: float, branch: float) -> bool:
    """Whether the harmonics of the drive next to a line are far smaller than it."""
    drive = 1.0 / (2.0 * branch * dt)
    around = [
        _amplitude(rest, line.frequency + which * drive, dt)
        for which in (-4, -3, -2, -1, 1, 2, 3, 4)
        if 0.0 < line.frequency + which * drive < 0.5 / dt
    ]
    return line.amplitude > _OVER_HARMONICS * max(around, default=0.0)


def _amplitude(signal: Array, frequency: float, dt: float) -> float:
    """Amplitude of a signal at a frequency, von Hann's window applied."""
    at = (np.arange(signal.size) + 0.5) / signal.size
    window = 1.0 - np.cos(2.0 * np.pi * at)
    wave = np.exp(-2j * np.pi * frequency * dt * np.arange(signal.size))
    return 2.0 * abs(complex(np.vdot(wave.conj(), window * signal))) / signal.size
