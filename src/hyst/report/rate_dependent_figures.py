"""Figures of the inversion of rate-dependent models: tracking, and error over frequency."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import StrMethodFormatter
from numpy.typing import NDArray

from hyst.report.canvas import FAINT, MEASURED, MODELLED, SECOND, blank, drawn

Array = NDArray[np.float64]

_COLOURS = {
    "rate-independent": MEASURED,
    "explicit": MODELLED,
    "sample-exact": FAINT,
    "preview": "#047857",
    "trajectory": SECOND,
}


@drawn
def draw_tracking(t: Array, y_ref: Array, outputs: dict[str, Array], heading: str) -> Figure:
    """Draw output over reference and the error over time.

    Parameters
    ----------
    t
        Time, seconds.
    y_ref
        Wanted output.
    outputs
        The model's output by method.
    heading
        Line above the figure.

    Returns
    -------
    bytes
        PNG.
    """
    figure, (left, right) = blank(2, 1, 10.5, 4.4)
    for method, y in outputs.items():
        colour = _COLOURS.get(method, MEASURED)
        left.plot(y_ref, y, color=colour, label=method)
        right.plot(t, y - y_ref, color=colour)
    left.set_title("Output over reference")
    left.set_xlabel("reference")
    left.set_ylabel("output")
    left.legend(loc="upper left")
    right.set_title("Error")
    right.set_xlabel("time [s]")
    right.set_ylabel("output - reference")
    figure.suptitle(heading)
    return figure


@drawn
def draw_error_over_frequency(
    frequencies: Sequence[float], errors: dict[str, dict[str, list[float]]]
) -> Figure:
    """Draw the largest error over frequency, one panel a model.

    Parameters
    ----------
    frequencies
        Hz.
    errors
        By model, then by method; one value a frequency.

    Returns
    -------
    bytes
        PNG.
    """
    figure, panels = blank(len(errors), 1, 10.5, 4.4)
    for axes, (model, by_method) in zip(panels, errors.items(), strict=True):
        for method, values in by_method.items():
            # What is exact but for rounding has no place on this scale.
            if max(values) > 1e-6:
                colour = _COLOURS.get(method, MEASURED)
                axes.loglog(frequencies, values, "o-", color=colour, markersize=3.5, label=method)
        # Powers of ten would need formulas, which names from users' files must not start.
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axes.set_title(model)
        axes.set_xlabel("frequency [Hz]")
        axes.set_ylabel("largest error")
    panels[0].legend(loc="upper left")
    return figure
