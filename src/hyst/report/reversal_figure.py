"""Why minor loops matter: hysteresis with nested memory beside memory of the last reversal."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hyst.models import RambergOsgood
from hyst.report.canvas import MODELLED, SECOND, blank, drawn
from hyst.signals import reversals

Array = NDArray[np.float64]


@drawn
def draw_memories(model: RambergOsgood, u: Array, t: Array) -> Figure:
    """Draw the loops and the outputs over time of a model in both memories.

    Parameters
    ----------
    model
        Its constants are used, in both memories.
    u
        Input, shape (N,).
    t
        Time, shape (N,), seconds.

    Returns
    -------
    bytes
        PNG.
    """
    figure, (left, middle, right) = blank(3, 1, 12.0, 4.0)
    nested, forgetful = model.with_memory("masing"), model.with_memory("last-reversal")
    for axes, each, colour, title in (
        (left, nested, SECOND, 'memory="masing": loops close'),
        (middle, forgetful, MODELLED, 'memory="last-reversal": drift'),
    ):
        axes.plot(u, each(u), color=colour)
        axes.set(title=title, xlabel="input", ylabel="output")
    right.plot(t, forgetful(u) - nested(u), color=MODELLED)
    right.set(title="what minor loops add up to", xlabel="time [s]", ylabel="difference of outputs")
    return figure


@drawn
def draw_collapse(model: RambergOsgood, u: Array) -> Figure:
    """Draw the slope of every branch over the way since its reversal (S3 Fig. 4).

    Parameters
    ----------
    model
        The model, taken with memory of the last reversal.
    u
        Input, shape (N,).

    Returns
    -------
    bytes
        PNG.
    """
    figure, (axes,) = blank(1, 1, 6.0, 4.0)
    y = model.with_memory("last-reversal")(u)
    turns = reversals(u, 0.0)
    for start, end in zip(turns, [*turns[1:], u.size - 1], strict=True):
        branch = slice(int(start), int(end) + 1)
        p = np.abs((u[branch][1:] + u[branch][:-1]) / 2.0 - u[start])
        du = np.diff(u[branch])
        moving = du != 0.0
        axes.plot(p[moving], np.diff(y[branch])[moving] / du[moving], lw=3.0, alpha=0.5)
    way = np.linspace(0.0, float(np.ptp(u)), 300)
    axes.plot(way, model.slope(way), "k--", lw=1.0)
    axes.set(title="every branch, one curve: M(p) = c1 + c2 p^c3", xlabel="p", ylabel="dy/du")
    return figure
