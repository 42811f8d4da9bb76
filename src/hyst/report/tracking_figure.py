"""How well outputs follow a reference, with different commands."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hyst.report.canvas import FAINT, MEASURED, MODELLED, SECOND, blank, drawn, with_unit

Array = NDArray[np.float64]

_COLOURS = (SECOND, MODELLED, "#047857", "#7c3aed")


@drawn
def draw_tracking(
    dt: float, y_ref: Array, outputs: Mapping[str, Array], name: str, unit: str, heading: str
) -> Figure:
    """Draw a reference with the outputs that should follow it, and their errors below.

    Parameters
    ----------
    dt
        Sample time, s.
    y_ref
        Wanted output, shape (N,), output units.
    outputs
        Outputs by what produced them, shape (N,) each.
    name, unit
        Of the output.
    heading
        Line above the figure; empty for none.

    Returns
    -------
    bytes
        PNG.
    """
    figure, (above, below) = blank(1, 2, 10.0, 6.0)
    below.sharex(above)
    t = np.arange(y_ref.size) * dt
    above.plot(t, y_ref, color=MEASURED, linewidth=3.0, alpha=0.5, label="reference")
    for (label, y), colour in zip(outputs.items(), _COLOURS, strict=False):
        above.plot(t, y, color=colour, linewidth=1.0, label=label)
        below.plot(t, y - y_ref, color=colour, linewidth=1.0, label=label)
    above.set_title("Reference and output")
    above.set_ylabel(with_unit(name, unit))
    above.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=1 + len(outputs))
    below.axhline(0.0, color=FAINT, zorder=0)
    below.set_title("Tracking error")
    below.set_ylabel(with_unit("error", unit))
    for axes in (above, below):
        axes.set_xlabel("time [s]")
    above.margins(x=0.01)
    if heading:
        figure.suptitle(heading)
    return figure
