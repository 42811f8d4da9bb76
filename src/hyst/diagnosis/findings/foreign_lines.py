"""Sines in the output that are not the drive's: mains hum, a fan, a vibration."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.drive_harmonics import is_between_tones, is_folded_harmonic
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
_MOST_PACES = 4
_MAINS = (50.0, 60.0)
# A harmonic of the drive has neighbours of its size; a line has none (amplitudes).
_OVER_HARMONICS = 3.0
_IN_EVERY_QUARTER, _OF_DRIVE = 0.4, 0.2  # amplitudes


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
    gain, span = _ratio(record), float(np.ptp(record.y))
    base = 1.0 / (repetition.period * record.dt)
    tones = [replace(each, amplitude=gain * each.amplitude) for each in lines_of(of_u, record.dt)]
    for line in lines_of(of_y, record.dt):
        # A sine and itself a lag ago: what is left of it depends on its phase over the lag.
        left = 2.0 * abs(np.sin(np.pi * line.frequency * lag * record.dt))
        if left <= 0.3 or _of_drive(of_u, line, record.dt, gain):
            continue
        if is_between_tones(line, tones, base, (stop - start) * record.dt):
            continue
        line = replace(line, amplitude=line.amplitude / float(left))
        if not is_folded_harmonic(line, repetition.period, record.dt, span, stop - start):
            found.append(line)
    return found


def _within_branches(record: Record) -> list[Line]:
    turns = turns_of(record.u)
    ends = np.concatenate([[0], turns, [record.samples]])
    lengths = np.diff(ends)
    usual = float(np.median(lengths))
    if usual < _FEWEST_SAMPLES or lengths.size > _MOST_BRANCHES:
        return []
    rest = _without_smooth(record.y, ends)
    drive, gain, paces = _without_smooth(record.u, ends), _ratio(record), _paces(lengths)
    # Of few branches what is left of a bend is not told from a line by its repetition.
    few = lengths.size < 6
    if few and usual < 3 * _FEWEST_SAMPLES:
        return []
    fewest_cycles = _DEGREE * (1.5 if few else 0.5)
    return [
        Line(line.frequency, line.amplitude / _left_of(line.frequency, ends, record.dt))
        for line in lines_of(rest, record.dt)
        if line.frequency * usual * record.dt > fewest_cycles
        and _throughout(rest, line, record.dt)
        and _alone(rest, line, record.dt, paces)
        and not _of_drive(drive, line, record.dt, gain)
    ]


def _ratio(record: Record) -> float:
    return float(np.ptp(record.y)) / float(np.ptp(record.u))


def _paces(lengths: NDArray[np.intp]) -> list[float]:
    """Give the lengths of branches that are frequent, those within a tenth alike."""
    left = np.sort(lengths).astype(np.float64)
    found: list[tuple[int, float]] = []
    while left.size:
        alike = left <= 1.1 * left[0]
        found.append((int(alike.sum()), float(np.median(left[alike]))))
        left = left[~alike]
    return [pace for _, pace in sorted(found, reverse=True)[:_MOST_PACES]]


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


def _left_of(frequency: float, ends: NDArray[np.intp], dt: float) -> float:
    """Give the share of a sine's amplitude that is not smooth within branches, 0.1 to 1."""
    phase = 2.0 * np.pi * frequency * dt * np.arange(int(ends[-1]))
    waves = [np.cos(phase), np.sin(phase)]
    left = sum(float(wave @ _without_smooth(wave, ends)) for wave in waves)
    return max(left / phase.size, 0.1)


def _basis(samples: int, degree: int) -> Array:
    t = np.linspace(-1.0, 1.0, samples)
    return np.linalg.qr(np.polynomial.legendre.legvander(t, degree))[0]


def _alone(rest: Array, line: Line, dt: float, branches: list[float]) -> bool:
    """Whether what is around a line, harmonics of the drive among it, is far smaller."""
    frequency, amplitude = _spectrum(rest, dt)
    away = np.abs(frequency - line.frequency)
    for drive in (1.0 / (2.0 * branch * dt) for branch in branches):
        # Four harmonics to either side; of a drive that wavers they are broad.
        around = (away > max(4.0 / (rest.size * dt), 0.3 * drive)) & (away < 4.3 * drive)
        if line.amplitude < _OVER_HARMONICS * float(amplitude[around].max(initial=0.0)):
            return False
    return True


def _throughout(rest: Array, line: Line, dt: float) -> bool:
    """Whether a line is there in every quarter of the record, at one phase."""
    wave = np.exp(-2j * np.pi * line.frequency * dt * np.arange(rest.size))
    quarters = np.array([2.0 * np.mean(part) for part in np.array_split(wave * rest, 4)])
    whole = quarters.mean()
    along = (quarters * np.conj(whole)).real / max(abs(whole), 1e-300)
    return bool(np.all(along > _IN_EVERY_QUARTER * line.amplitude))


def _of_drive(drive: Array, line: Line, dt: float, gain: float) -> bool:
    """Whether the drive itself has at that frequency what would explain a line."""
    frequency, amplitude = _spectrum(drive, dt)
    near = np.abs(frequency - line.frequency) < 3.0 / (drive.size * dt)
    return gain * float(amplitude[near].max(initial=0.0)) > _OF_DRIVE * line.amplitude


def _spectrum(signal: Array, dt: float) -> tuple[Array, Array]:
    """Give frequencies and amplitudes, von Hann's window applied."""
    window = 1.0 - np.cos(2.0 * np.pi * (np.arange(signal.size) + 0.5) / signal.size)
    amplitude = 2.0 * np.abs(np.fft.rfft(window * signal)) / signal.size
    frequency: Array = np.arange(amplitude.size) / (signal.size * dt)
    return frequency, amplitude
