"""What a model file keeps of how well dynamics are known: for a controller that is to bear it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.fft
from numpy.typing import NDArray

from hyst.identification.families.hammerstein.told.known_dynamics import KnownDynamics
from hyst.identification.families.hammerstein.yardstick.yardstick import Stretch
from hyst.operators.dynamics_errors import DynamicsErrors

Array = NDArray[np.float64]

_POINTS, _AROUND = 60, np.linspace(-3.0, 3.0, 13)  # of the grid; half-widths about a resonance
_DECADES_BELOW = 100.0  # from the lowest frequency shown
_WIDTHS = (2.0 ** (1 / 6), 2.0 ** (1 / 24), 2.0 ** (1 / 96))  # of bands, on either side
_LEAST_LINES = 8  # of a band that tells anything
_SEEN = 3.0  # standard errors from which a deviation is one: chance makes one of 8000 so large
_NARROW_GAP = 2.0  # a mode in a gap of an octave is within an octave of what is shown
_LEAST_TOLD = 1e-9  # what rounding leaves


def kept_errors(
    known: KnownDynamics, stretches: Sequence[Stretch], slope_error: float | None
) -> DynamicsErrors | None:
    """Give what a model file keeps of how well dynamics are known.

    Parameters
    ----------
    known
        What the fit tells of G.
    stretches
        Of its records, with the output of the model.
    slope_error
        Of the hysteresis.

    Returns
    -------
    DynamicsErrors or None
        None of dynamics that were given: their errors are not the records' to tell.
    """
    if known.is_held:
        return None
    response = known.frequency_response(_frequencies(known))
    squares = np.square(response.gain_error) + np.square(np.radians(response.phase_error))
    determined = np.isfinite(squares)
    frequency, error = response.frequency[determined], np.sqrt(squares[determined])
    return DynamicsErrors(
        tuple(frequency.tolist()),
        tuple(error.tolist()),
        tuple(missing_over_frequency(stretches, known.dynamics.dt, frequency).tolist()),
        _bands(known),
        slope_error,
    )


def missing_over_frequency(stretches: Sequence[Stretch], dt: float, frequency: Array) -> Array:
    """Tell by how much dynamics visibly differ from those of a model.

    What the model leaves, E, over what it gives, M, in bands about each frequency:
    ``sum E M* / sum |M|^2`` is ``P/G - 1`` there, with a standard error by what it does not
    explain of E. Of several widths the largest share counts that is three of them.

    Parameters
    ----------
    stretches
        Of the records, with the output of the model.
    dt
        Sample time, s.
    frequency
        Shape (p,), Hz.

    Returns
    -------
    numpy.ndarray
        Shape (p,), 0 where nothing is seen.
    """
    sums = [_Sums.of(each, dt) for each in stretches]
    largest = np.zeros(frequency.size)
    for width in _WIDTHS:
        cross = np.zeros(frequency.size, dtype=complex)
        given, left, lines = (np.zeros(frequency.size) for _ in range(3))
        for each in sums:
            bands = each.within(frequency / width, frequency * width)
            cross, given, left = cross + bands[0], given + bands[1], left + bands[2]
            lines = lines + bands[3]
        with np.errstate(all="ignore"):
            share = np.abs(cross) / given
            rest = np.maximum(left - np.square(share) * given, 0.0) / np.maximum(lines - 1.0, 1.0)
            seen = (lines >= _LEAST_LINES) & (share > _SEEN * np.sqrt(rest / given))
        seen &= np.isfinite(share) & (share > _LEAST_TOLD)
        largest[seen] = np.maximum(largest[seen], share[seen])
    return largest


@dataclass(frozen=True, eq=False)
class _Sums:
    """Running sums over the lines of a spectrum."""

    line: float  # Hz
    cross: NDArray[np.complex128]
    given: Array
    left: Array

    @classmethod
    def of(cls, stretch: Stretch, dt: float) -> _Sums:
        modelled = stretch.modelled[stretch.start :]
        window = np.sin(np.pi * (np.arange(modelled.size) + 0.5) / modelled.size)
        M = scipy.fft.rfft(window * (modelled - modelled.mean()))
        E = scipy.fft.rfft(window * (stretch.error - stretch.error.mean()))
        products = E * np.conj(M), np.square(np.abs(M)), np.square(np.abs(E))
        cross, given, left = (np.concatenate([[0.0], np.cumsum(each)]) for each in products)
        return cls(1.0 / (modelled.size * dt), cross, given, left)

    def within(self, low: Array, high: Array) -> tuple[NDArray[np.complex128], Array, Array, Array]:
        """Give the sums of each band, and how many independent lines it has."""
        last = self.given.size - 1
        start = np.clip(np.ceil(low / self.line), 1, last).astype(int)
        stop = np.clip(np.floor(high / self.line) + 1, start, last).astype(int)
        sums = (each[stop] - each[start] for each in (self.cross, self.given, self.left))
        return (*sums, (stop - start) / 1.5)  # neighbours share what a window spreads


def _frequencies(known: KnownDynamics) -> Array:
    """Give a grid from far below what the drive shows to half the sample rate, Hz."""
    nyquist = 0.5 / known.dynamics.dt
    bands = known.band.bands()
    lowest = bands[0][0] if bands else 0.01 * nyquist
    grid = [np.geomspace(min(lowest, 0.1 * nyquist) / _DECADES_BELOW, nyquist, _POINTS)]
    for each in (*known.poles, *known.zeros):
        if each.is_pair and abs(each.damping) < 0.3:
            grid.append(each.frequency * (1.0 + abs(each.damping) * _AROUND))
    frequency = np.unique(np.concatenate(grid))
    return np.asarray(frequency[(frequency >= grid[0][0]) & (frequency <= nyquist)])


def _bands(known: KnownDynamics) -> tuple[tuple[float, float], ...]:
    """Give the bands that are shown, gaps of less than an octave closed."""
    joined: list[tuple[float, float]] = []
    for low, high in known.band.bands():
        if joined and low <= _NARROW_GAP * joined[-1][1]:
            joined[-1] = (joined[-1][0], high)
        else:
            joined.append((low, high))
    return tuple(joined)
