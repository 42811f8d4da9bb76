"""A record, and what it shows before any model: diagnosis, loop, signals and spectrum."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis import diagnose
from hyst.io import read_record
from hyst.signals import Record
from hyst.studio.drawing.extremes import extreme_samples
from hyst.studio.drawing.plot import Line, Plot
from hyst.studio.work.choice import Choice

Array = NDArray[np.float64]

COLUMNS = 500
"""Stretches of which the extremes are drawn: a plot is some 500 pixels wide."""

KINDS: tuple[Literal["solid", "dashed"], ...] = ("solid", "dashed")
"""Of the lines of models, in turn."""

_BINS = 240


@dataclass(frozen=True)
class Measured:
    """A record as the page shows it.

    Parameters
    ----------
    samples, dt
        Number and sample time, s.
    input_label, output_label
        Names with units.
    output_range
        Lowest and highest output.
    findings
        Severity, name, sentence and advice of each, the worst first.
    notes
        What reading found out, left out or repaired.
    loop, signals, spectrum
        Pictures.
    """

    samples: int
    dt: float
    input_label: str
    output_label: str
    output_range: tuple[float, float]
    findings: tuple[tuple[str, str, str, str], ...]
    notes: tuple[str, ...]
    loop: str
    signals: str
    spectrum: str


def measure(path: Path, choice: Choice, tell: Callable[..., None]) -> Measured:
    """Read a record and say what it shows.

    Parameters
    ----------
    path, choice
        The file and how to read it.
    tell
        Not told anything.

    Raises
    ------
    InputError
        If it cannot be read so.
    """
    record = record_of(path, choice)
    found = diagnose(record)
    findings = tuple(
        (each.severity, each.name, each.sentence, each.advice) for each in found.findings
    )
    names = labels_of(record)
    return Measured(
        len(record),
        record.dt,
        *names,
        (float(record.y.min()), float(record.y.max())),
        findings,
        tuple(record.notes),
        loop_plot(record, []).svg(),
        _signals(record, names),
        _spectrum(record),
    )


def record_of(path: Path, choice: Choice) -> Record:
    """Give the record of a file, which is read again only where something changed.

    Parameters
    ----------
    path, choice
        The file and how to read it.

    Raises
    ------
    InputError
        If it cannot be read so.
    """
    arguments = choice.arguments()
    stat = path.stat()
    return _read(path, stat.st_mtime_ns, stat.st_size, tuple(arguments.items()))


@lru_cache(maxsize=2)
def _read(path: Path, changed: int, size: int, arguments: tuple[tuple[str, Any], ...]) -> Record:
    return read_record(path, **dict(arguments))


def labels_of(record: Record) -> tuple[str, str]:
    """Name input and output with their units."""
    names = (record.input_name or "input", record.output_name or "output")
    units = (record.input_unit, record.output_unit)
    u, y = (f"{n} [{unit}]" if unit else n for n, unit in zip(names, units, strict=True))
    return u, y


def loop_plot(record: Record, others: list[tuple[str, Array]]) -> Plot:
    """Draw output over input, and outputs of models in front.

    Parameters
    ----------
    record
        The record.
    others
        Names and outputs at its samples.
    """
    u_label, y_label = labels_of(record)
    chosen = extreme_samples(COLUMNS, record.u, record.y)
    lines = [Line(record.u[chosen], record.y[chosen], "measured" if others else "", 0)]
    for k, (name, y) in enumerate(others):
        at = extreme_samples(COLUMNS, record.u, y)
        lines.append(Line(record.u[at], y[at], name, 1 + k % 6, KINDS[k % 2]))
    told = (
        f"Loop: {y_label} from {record.y.min():.4g} to {record.y.max():.4g} over {u_label} from "
        f"{record.u.min():.4g} to {record.u.max():.4g}"
    )
    models = f", with the models {', '.join(name for name, _ in others)}" if others else ""
    return Plot(lines, u_label, y_label, told + models)


def _signals(record: Record, names: tuple[str, str]) -> str:
    lines = []
    for k, (signal, name) in enumerate(zip((record.u, record.y), names, strict=True)):
        span = float(np.ptp(signal)) or 1.0
        share = (signal - signal.min()) / span - 1.15 * k
        at = extreme_samples(COLUMNS, share)
        lines.append(Line((at * record.dt).astype(np.float64), share[at], name, k, "solid"))
    told = f"Over {len(record) * record.dt:.4g} s: {names[0]} above, {names[1]} below"
    return Plot(lines, "time [s]", "shares of the ranges", told).svg()


def _spectrum(record: Record) -> str:
    lines, told = [], []
    for k, (signal, name) in enumerate(zip((record.u, record.y), ("input", "output"), strict=True)):
        f, a = spectrum_of(signal, record.dt)
        lines.append(Line(f, a, name, k))
        told.append(f"{name} strongest at {f[a.argmax()]:.3g} Hz" if a.size else name)
    return Plot(
        lines,
        "frequency [Hz]",
        "amplitude / range",
        f"Spectrum: {', '.join(told)}",
        logarithmic=True,
    ).svg()


def spectrum_of(signal: Array, dt: float) -> tuple[Array, Array]:
    """Give frequencies and the largest amplitudes near them, as shares of the signal's range.

    Parameters
    ----------
    signal, dt
        Shape (N,), and its sample time, s.
    """
    window = np.hanning(signal.size)
    span = float(np.ptp(signal)) or 1.0
    lines = np.abs(np.fft.rfft((signal - signal.mean()) * window)) * 2.0 / (window.sum() * span)
    f = np.fft.rfftfreq(signal.size, dt)[1:].astype(np.float64)
    lines = np.maximum(lines[1:], 1e-9).astype(np.float64)
    if f.size <= _BINS:
        return f, lines
    edges = np.geomspace(f[0], f[-1], _BINS + 1)
    begins = np.unique(np.searchsorted(f, edges[:-1]))
    return f[begins], np.asarray(np.maximum.reduceat(lines, begins))
