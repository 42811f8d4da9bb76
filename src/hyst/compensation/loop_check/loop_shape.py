"""The shape of a loop in a few numbers: harmonics over the phase of the input, cycle by cycle.

Behind a hysteresis that knows no rate, v of a drive that repeats depends on where the input stands
on its way, however fast it goes that way. So over the phase of the input the harmonics of v are the
same at all frequencies: of the first, the part in phase is the gain of the loop and the part a
quarter behind its width; the others are its shape. The mean is left out, which sensors do not keep.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.compensation.loop_check.harmonics import harmonics_of, signal_of
from hyst.compensation.loop_check.repeated_cycles import RepeatedCycles

Array = NDArray[np.float64]

HARMONICS = 3

DELAYS = np.linspace(-6.0, 6.0, 25)
"""Samples, between which a delay is looked for where the input is no sine."""

_MOST_PARTS = 16  # of a stretch whose scatter is taken: long ones tell slow noise, too
_MOST_HARMONICS = 20
_SURE_TO = 1e-6  # of the range: no simulation and no inverse is better


@dataclass(frozen=True, eq=False)
class LoopShape:
    """Harmonics of v on a stretch, of the model and of what v has beside the model.

    Each has the shape (harmonics, 2): parts in phase with the input and behind it, units of v.

    Parameters
    ----------
    modelled
        Of the model's hysteresis.
    beside
        Of v minus that of the model, mean of the cycles.
    variance
        Of ``beside``, of either part, shape (harmonics,).
    freedom
        Degrees of freedom of the variance.
    late
        Shape (delays, harmonics, 2): ``modelled`` as it would be late by each of ``DELAYS``
        samples, where the input is no sine; empty of a sine, of which it is known.
    noise
        Standard deviation of single samples of v beside what repeats.
    repeats
        Rms of what repeats of v minus that of the model, its mean taken out.
    """

    modelled: Array
    beside: Array
    variance: Array
    freedom: int
    late: Array
    noise: float
    repeats: float

    @property
    def seen(self) -> Array:
        """Give the harmonics of v itself."""
        return np.asarray(self.modelled + self.beside)

    def beside_at(self, phase: Array) -> Array:
        """Give ``beside`` over a phase, rad, shape (N,)."""
        return signal_of(self.beside, phase)

    def up_to(self, harmonics: int) -> LoopShape:
        """Leave out harmonics beyond so many."""
        return LoopShape(
            self.modelled[:harmonics],
            self.beside[:harmonics],
            self.variance[:harmonics],
            self.freedom,
            self.late[:, :harmonics],
            self.noise,
            self.repeats,
        )


def shape_of(
    v: Array, modelled: Array, cycles: RepeatedCycles, harmonics: int, doubt: Array
) -> LoopShape:
    """Take the harmonics of a stretch, with what noise makes of them.

    The scatter between cycles is the noise, whatever its colour; of many cycles, neighbours are
    taken together.

    Parameters
    ----------
    v, modelled
        Shape (N,): the signal behind the hysteresis, from the output and by the model.
    cycles
        The stretch.
    harmonics
        How many.
    doubt
        Shape of the stretch: by what the model may be wrong because its input is noisy.
    """
    window = cycles.window
    model, beside = modelled[window], (v - modelled)[window]
    beside = beside - _drift(beside, cycles)
    mean, scatter, parts = _mean_and_scatter(beside, cycles, harmonics)
    floor = np.square(_SURE_TO * float(np.ptp(model)))
    noise, repeats = _apart(beside, cycles)
    unsure = np.square(_harmonics(doubt, cycles, harmonics)).mean(axis=1)
    return LoopShape(
        modelled=_harmonics(model, cycles, harmonics),
        beside=mean,
        variance=scatter.mean(axis=1) + floor + unsure,
        freedom=2 * (parts - 1),
        late=_late(modelled, cycles, harmonics),
        noise=noise,
        repeats=repeats,
    )


def _drift(signal: Array, cycles: RepeatedCycles) -> Array:
    """Give the straight line through the means of the cycles."""
    count = np.bincount(cycles.cycle)
    mean = np.bincount(cycles.cycle, signal) / count
    at = np.arange(signal.size, dtype=np.float64)
    centre = np.bincount(cycles.cycle, at) / count
    slope = np.polyfit(centre - centre.mean(), mean - mean.mean(), 1)[0]
    return np.asarray(mean.mean() + slope * (at - centre.mean()))


def _harmonics(signal: Array, cycles: RepeatedCycles, count: int) -> Array:
    return harmonics_of(signal, cycles.phase, cycles.weight, count)


def _late(modelled: Array, cycles: RepeatedCycles, harmonics: int) -> Array:
    """Give the harmonics of a model that is late, straight between samples."""
    if cycles.is_sine:
        return np.empty((0, harmonics, 2))
    at, k = np.arange(cycles.start, cycles.stop), np.arange(modelled.size)
    return np.array(
        [_harmonics(np.interp(at - late, k, modelled), cycles, harmonics) for late in DELAYS]
    )


def _mean_and_scatter(
    signal: Array, cycles: RepeatedCycles, harmonics: int
) -> tuple[Array, Array, int]:
    """Give the mean of the harmonics over the parts of a stretch, its variance, and how many."""
    parts = min(cycles.cycles, _MOST_PARTS)
    part = (cycles.cycle * parts) // cycles.cycles
    phase, weight = cycles.phase, cycles.weight
    chosen = (part == number for number in range(parts))
    by_part = np.array(
        [harmonics_of(signal[at], phase[at], weight[at], harmonics) for at in chosen]
    )
    return by_part.mean(axis=0), by_part.var(axis=0, ddof=1) / parts, parts


def _apart(beside: Array, cycles: RepeatedCycles) -> tuple[float, float]:
    """Give the standard deviation of what does not repeat, and the rms of what does."""
    a_cycle = beside.size / cycles.cycles
    harmonics = int(np.clip(a_cycle / 6.0, 1, _MOST_HARMONICS))
    mean, scatter, _ = _mean_and_scatter(beside, cycles, harmonics)
    left = beside - signal_of(mean, cycles.phase)
    freedom = max(beside.size - mean.size - 1, 1)
    variance = float(np.square(left - left.mean()).sum()) / freedom
    power = 0.5 * float((np.square(mean) - scatter).sum())
    return float(np.sqrt(variance)), float(np.sqrt(max(power, 0.0)))


def distance(one: Array, other: Array) -> float:
    """Give how far apart two loops are at most, from their harmonics.

    Parameters
    ----------
    one, other
        Shape (harmonics, 2), units of v.
    """
    phase = np.linspace(0.0, 2.0 * np.pi, 180, endpoint=False)
    return float(np.abs(signal_of(one - other, phase)).max())
