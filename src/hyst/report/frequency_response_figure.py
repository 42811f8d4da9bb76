"""The frequency response of identified dynamics with the band in which it is known."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hyst.identification.families.hammerstein.told.frequency_response import FrequencyResponse
from hyst.identification.families.hammerstein.told.identified_hammerstein import (
    IdentifiedHammerstein,
)
from hyst.models import LinearDynamics
from hyst.report.canvas import FAINT, MEASURED, MODELLED, SECOND, blank, drawn

Array = NDArray[np.float64]

_MOST_DECADES = 4.0  # of gain below its largest
_APART = 40.0  # ratio of frequencies at which two names stand beside each other


@drawn
def draw_dynamics(found: IdentifiedHammerstein) -> Figure:
    """Draw gain and phase of G over frequency with their 95 % bands, as PNG."""
    figure, (gain, phase) = blank(2, 1, 10.0, 4.4)
    response = found.frequency_response()
    frequency = response.frequency
    if found.first_dynamics is not None:
        _realization(gain, phase, response, found.first_dynamics)
    _band(gain, frequency, *response.gain_band())
    gain.loglog(frequency, response.gain, color=MODELLED, label="identified G")
    _band(phase, frequency, *response.phase_band())
    phase.semilogx(frequency, response.phase, color=MODELLED)
    highest = float(response.gain.max())
    lowest = max(float(response.gain.min()), highest * 10.0**-_MOST_DECADES)
    gain.set_ylim(0.5 * lowest, 2.0 * highest)
    low, high = float(response.phase.min()), float(response.phase.max())
    margin = 0.1 * (high - low) + 10.0
    phase.set_ylim(low - margin, high + margin)
    for axes in (gain, phase):
        _extrapolation(axes, frequency, response.excited)
        axes.set_xlim(frequency[0], frequency[-1])
    _resonances(gain, found)
    gain.set_ylabel("gain of G (1 at rest)")
    phase.set_ylabel("phase of G [degrees]")
    gain.set_xlabel("frequency [Hz]")
    phase.set_xlabel("frequency [Hz]")
    gain.legend(loc="lower left")
    return figure


def _realization(
    gain: Axes, phase: Axes, response: FrequencyResponse, first: LinearDynamics
) -> None:
    """Draw what the impulse response alone says, its phase by whole turns near the other."""
    values = first.frequency_response(response.frequency)
    degrees = np.degrees(np.unwrap(np.angle(values)))
    turns = 360.0 * np.round((response.phase[0] - degrees[0]) / 360.0)
    frequency = response.frequency
    gain.loglog(frequency, np.abs(values), color=MEASURED, linewidth=0.9, label="first realization")
    phase.semilogx(frequency, degrees + turns, color=MEASURED, linewidth=0.9)


def _band(axes: Axes, frequency: Array, low: Array, high: Array) -> None:
    known = np.isfinite(low) & np.isfinite(high)
    axes.fill_between(
        frequency,
        np.where(known, low, np.nan),
        np.where(known, high, np.nan),
        color=MODELLED,
        alpha=0.25,
        linewidth=0.0,
        label="95 % band",
    )


def _extrapolation(axes: Axes, frequency: Array, excited: NDArray[np.bool_]) -> None:
    """Shade where the drive had no power."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], ~excited, [0]])))
    for count, (first, last) in enumerate(edges.reshape(-1, 2)):
        start = frequency[max(first - 1, 0)] if first else frequency[0]
        end = frequency[min(last, frequency.size - 1)]
        label = "extrapolation: not shown by the drive" if count == 0 else None
        axes.axvspan(start, end, color=FAINT, alpha=0.6, linewidth=0.0, zorder=0.5, label=label)


def _resonances(axes: Axes, found: IdentifiedHammerstein) -> None:
    """Name the resonances at the upper edge, close ones below each other."""
    row, before = 0, 0.0
    for each in found.resonances:
        row = row + 1 if each.frequency < _APART * before else 0
        before = each.frequency
        axes.axvline(each.frequency, color=SECOND, linestyle=":", linewidth=0.9)
        told = f" {each.frequency:.4g} Hz" + ("" if each.is_determined else ": not determined")
        axes.annotate(
            told,
            (each.frequency, 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(0, -11 - 12 * row),
            textcoords="offset points",
            color=SECOND,
            fontsize=9.0,
        )
