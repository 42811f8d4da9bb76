"""Where the drive had the power to show the dynamics.

The lines of a drive within an octave of a frequency determine the gain of G there with the relative
standard error ``1 / sqrt(sum |g G U_i|^2 / |E_i|^2)``, where g is the gain of the hysteresis, U_i
the spectrum of the drive and E_i that of the noise. Where it is above a tenth, or there is no line,
a response is an extrapolation by the model of G.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.fft
from numpy.typing import ArrayLike, NDArray

from hyst.models import LinearDynamics
from hyst.signals import Record

Array = NDArray[np.float64]

OCTAVE = 2.0
"""Ratio to the nearest line up to which the drive counts as having power."""

ENOUGH = 100.0
"""Power over noise power, summed over the lines: a gain known to a tenth."""

_TAPER = 0.1  # share of a record at either end: a chirp loses an octave or two by it
_LEAKAGE = 1e-5  # of the largest line: less is the taper's
_QUIET = 1e-12  # of the output: what rounding leaves
_PER_OCTAVE = 48
_ONE_SINE = 0.999  # of the power of a drive: a triangle has 0.986 in its first line
_BINS, _WIDTH = 4, 0.01  # of one line: its window, or the share of its frequency


@dataclass(frozen=True, eq=False)
class DriveBand:
    """Frequencies at which a drive shows dynamics.

    Parameters
    ----------
    lines
        Shape (q,), Hz, ascending, above 0: where the drive has power.
    evidence
        Shape (q,), what each adds: its power at the output over the power of the noise.
    nyquist
        Half the sample rate, Hz.
    only_line
        Hz, of a drive that is one sine in all records; NaN of others.
    """

    lines: Array
    evidence: Array
    nyquist: float
    only_line: float = float("nan")

    def excites(self, frequency: ArrayLike) -> NDArray[np.bool_]:
        """Tell at which frequencies the drive had power within an octave.

        Parameters
        ----------
        frequency
            Shape (p,), Hz.
        """
        wanted = np.atleast_1d(np.asarray(frequency, dtype=np.float64))
        sums = np.concatenate([[0.0], np.cumsum(self.evidence)])
        first = np.searchsorted(self.lines, wanted / OCTAVE, side="left")
        last = np.searchsorted(self.lines, wanted * OCTAVE, side="right")
        # The least that a line can add, else rounding of the sums would be evidence.
        return np.asarray((last > first) & (sums[last] - sums[first] >= ENOUGH))

    def bands(self) -> tuple[tuple[float, float], ...]:
        """Give the bands that are excited, each from its lowest to its highest frequency, Hz."""
        if self.lines.size == 0:
            return ()
        low, high = self.lines[0] / OCTAVE, min(OCTAVE * self.lines[-1], self.nyquist)
        count = 2 + int(_PER_OCTAVE * np.log2(high / low))
        grid = np.geomspace(low, high, count)
        edges = np.flatnonzero(np.diff(np.concatenate([[0], self.excites(grid), [0]])))
        inside = edges.reshape(-1, 2)
        return tuple((float(grid[a]), float(grid[b - 1])) for a, b in inside)


def drive_band(
    records: Sequence[Record], dynamics: LinearDynamics, gain: float, noise_rms: float
) -> DriveBand:
    """Find where drives show dynamics.

    Parameters
    ----------
    records
        With the drives.
    dynamics
        As identified.
    gain
        Of the hysteresis in front: output over input units.
    noise_rms
        What the model leaves of the output, output units.

    Returns
    -------
    DriveBand
    """
    nyquist = 0.5 / dynamics.dt
    parts = [_lines_of(each, dynamics, gain, noise_rms) for each in records]
    sines = np.array([_one_sine(each) for each in records])
    same = bool(np.ptp(sines) <= _WIDTH * sines.mean())  # not of NaN
    lines = np.concatenate([np.empty(0), *(each for each, _ in parts)])
    evidence = np.concatenate([np.empty(0), *(each for _, each in parts)])
    order = np.argsort(lines, kind="stable")
    only = float(sines.mean()) if same else float("nan")
    return DriveBand(lines[order], evidence[order], nyquist, only)


def _one_sine(record: Record) -> float:
    """Give the frequency of a drive that is one sine, Hz; NaN of another."""
    frequency, power = _spectrum(record, np.hanning(len(record)))  # leaks to two bins
    near = _of_the_top(frequency, power)
    is_one = float(power[near].sum()) > _ONE_SINE * float(power.sum())
    return float(frequency[power.argmax()]) if is_one else float("nan")


def _of_the_top(frequency: Array, power: Array) -> NDArray[np.bool_]:
    """Tell which frequencies are of the largest line."""
    top = float(frequency[power.argmax()])
    width = max(_WIDTH * top, _BINS * float(frequency[1]))
    return np.asarray(np.abs(frequency - top) <= width)


def _spectrum(record: Record, window: Array) -> tuple[Array, Array]:
    """Give frequencies, Hz, and the power of a drive about its mean, through a window."""
    u = record.u
    middle = float(window @ u / max(float(window.sum()), 1.0))
    power = np.square(np.abs(scipy.fft.rfft((u - middle) * window)))
    return np.arange(power.size) / (u.size * record.dt), power


def _lines_of(
    record: Record, G: LinearDynamics, gain: float, noise_rms: float
) -> tuple[Array, Array]:
    """Give lines of a drive, Hz, and what each tells of the dynamics."""
    u, window = record.u, _window(len(record))
    frequency, spectrum = _spectrum(record, window)
    shown = spectrum > _LEAKAGE**2 * spectrum[1:].max(initial=0.0)
    shown[0] = False
    if not np.isnan(_one_sine(record)):
        shown &= _of_the_top(frequency, spectrum)  # a short taper leaks further than that
    spectrum, frequency = spectrum[shown], frequency[shown]
    at_output = gain**2 * spectrum * np.square(np.abs(_gains(G, frequency)))
    weight = float(window @ window)
    quiet = _QUIET**2 * float(at_output.sum()) * 4.0 / max(u.size * weight, 1.0)
    noise = max(noise_rms**2, quiet) * weight
    return frequency, at_output / noise if noise > 0.0 else at_output


def _gains(G: LinearDynamics, frequency: Array) -> Array:
    """Give the gain of G at many frequencies, in between those of a grid by straight lines."""
    if frequency.size <= 4096:
        return np.abs(G.frequency_response(frequency))
    grid = np.concatenate([[0.0], np.geomspace(frequency[0], frequency[-1], 4096)])
    return np.interp(frequency, grid, np.abs(G.frequency_response(grid)))


def _window(count: int) -> Array:
    """Give a window that rises from 0 and falls to it with all derivatives (Planck's taper)."""
    window = np.ones(count)
    rise = int(_TAPER * count)
    if rise >= 2:
        at = np.arange(1, rise) / rise
        with np.errstate(over="ignore"):
            window[1:rise] = 1.0 / (1.0 + np.exp(1.0 / at - 1.0 / (1.0 - at)))
        window[0] = 0.0
        window[-rise:] = window[rise - 1 :: -1]
    return window
