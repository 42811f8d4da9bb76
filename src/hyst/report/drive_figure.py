"""A drive: over time, over frequency, and how often it is where."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from hyst.report.canvas import MEASURED, MODELLED, SECOND, blank, drawn, with_unit
from hyst.signals import Drive

_SHOWN = 4000  # samples of a long drive that are drawn over time
_WIDE = 30.0  # half the sample rate over the lowest line: beyond, frequency is drawn by octaves


@drawn
def draw_drive(drive: Drive, name: str, unit: str, resonances: Sequence[float] = ()) -> Figure:
    """Draw a designed drive.

    Parameters
    ----------
    drive
        The drive.
    name, unit
        Of the input.
    resonances
        Hz, marked in the spectrum.

    Returns
    -------
    bytes
        PNG.
    """
    figure, (over_time, over_frequency, values) = blank(3, 1, 12.0, 3.9)
    shown = min(len(drive), max(_SHOWN, drive.period if drive.period <= 10 * _SHOWN else 0))
    over_time.plot(drive.time[:shown], drive.u[:shown], color=MODELLED, linewidth=0.8)
    over_time.set_title(drive.kind if shown == len(drive) else f"{drive.kind}, its beginning")
    over_time.set_xlabel("time [s]")
    over_time.set_ylabel(with_unit(name, unit))
    period = drive.u[: drive.period] if drive.period else drive.u
    spectrum = np.abs(np.fft.rfft(period - period.mean())) * 2.0 / period.size
    frequency = np.fft.rfftfreq(period.size, drive.dt)
    shows = spectrum > 1e-6 * spectrum.max(initial=0.0)
    over_frequency.plot(frequency[shows], spectrum[shows], ".", markersize=2.0, color=SECOND)
    over_frequency.set_yscale("log")
    if shows.any():
        # The lines of a binary sequence are all alike: without room the axis would have no height.
        over_frequency.set_ylim(0.5 * spectrum[shows].min(), 2.0 * spectrum[shows].max())
    lowest = float(frequency[shows].min()) if shows.any() else 0.0
    if 0.0 < lowest < 0.5 / drive.dt / _WIDE:
        over_frequency.set_xscale("log")  # on which a fall by a power of f is a straight line
        over_frequency.set_xlim(lowest, 0.5 / drive.dt)
    else:
        over_frequency.set_xlim(0.0, 0.5 / drive.dt)
    for each in resonances:
        over_frequency.axvline(each, color=MODELLED, linewidth=0.8, linestyle="--")
    over_frequency.set_title(
        "Amplitude of its lines, stated resonances" if resonances else "Amplitude of its lines"
    )
    over_frequency.set_xlabel("frequency [Hz], up to half the sample rate")
    values.hist(drive.u, bins=80, color=MEASURED)
    values.set_title("How often it is where")
    values.set_xlabel(with_unit(name, unit))
    return figure
