"""Figures 3 to 6 of the study of Hammerstein identification, the printed ones computed anew."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hyst.models import LinearDynamics
from hyst.report.canvas import MEASURED, MODELLED, SECOND, blank, drawn

Array = NDArray[np.float64]

_COLORS = (MODELLED, SECOND, "#15803d")


@drawn
def draw_markov(true: Array, estimates: Mapping[str, Array]) -> Figure:
    """Draw true Markov parameters and estimates of them after scaling (fig. 3), as PNG."""
    figure, (axes,) = blank(1, 1, 7.0, 4.0)
    lags = np.arange(true.size)
    axes.plot(lags, true, "o", color=MEASURED, fillstyle="none", markersize=8.0, label="G")
    for color, (name, values) in zip(_COLORS, estimates.items(), strict=False):
        axes.plot(lags, values, ".-", color=color, linewidth=0.7, label=name)
    axes.set_title("Markov parameters after scaling")
    axes.set_xlabel("samples")
    axes.legend()
    return figure


@drawn
def draw_bode(true: LinearDynamics, estimates: Mapping[str, LinearDynamics]) -> Figure:
    """Draw the frequency responses of the true system and of estimates (fig. 4), as PNG."""
    figure, (gain, phase) = blank(2, 1, 10.0, 3.9)
    frequency = np.geomspace(0.1, 0.499 / true.dt, 500)
    systems = {"G": true, **estimates}
    for color, (name, system) in zip((MEASURED, *_COLORS), systems.items(), strict=False):
        response = system.frequency_response(frequency) / system.dc_gain()
        style = "-" if name == "G" else "--"
        gain.loglog(frequency, np.abs(response), style, color=color, label=name)
        phase.semilogx(frequency, np.degrees(np.unwrap(np.angle(response))), style, color=color)
    gain.set_title("Gain over that at rest")
    phase.set_title("Phase [degrees]")
    for axes in (gain, phase):
        axes.set_xlabel("frequency [Hz]")
    gain.legend()
    return figure


@drawn
def draw_intermediate(time: Array, v: Array, v_hat: Array, title: str) -> Figure:
    """Draw v and its estimate v_hat over time (figs. 5 and 6 top) with a title, as PNG."""
    figure, (axes,) = blank(1, 1, 8.0, 3.9)
    axes.plot(time, v, color=MEASURED, linewidth=2.4, label="v")
    axes.plot(time, v_hat, "--", color=MODELLED, label="estimate")
    axes.set_title(title)
    axes.set_xlabel("time [s]")
    axes.legend()
    return figure


@drawn
def draw_loops(u: Array, v: Array, v_hat: Array, title: str) -> Figure:
    """Draw v and its estimate v_hat over u (fig. 6 bottom) with a title, as PNG."""
    figure, (axes,) = blank(1, 1, 6.0, 4.4)
    axes.plot(u, v, color=MEASURED, linewidth=2.4, label="v over u")
    axes.plot(u, v_hat, "--", color=MODELLED, label="estimate over u")
    axes.set_title(title)
    axes.set_xlabel("u")
    axes.legend()
    return figure
