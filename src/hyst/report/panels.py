"""A figure of several panels, each with a few lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hyst.report.canvas import FAINT, MEASURED, MODELLED, SECOND, blank, drawn

Array = NDArray[np.float64]

COLOURS = (SECOND, MODELLED, "#047857", "#7c3aed")
_STYLES = ("-", "--", "-.", ":")
_MOST_POINTS = 6000


@dataclass(frozen=True, eq=False)
class Panel:
    """One set of axes.

    Parameters
    ----------
    title, xlabel, ylabel
        Texts; empty for none.
    lines
        By label, x and y of shape (N,) each; labels that begin with ``_`` are not shown.
    logarithmic
        Whether both axes are.
    limit
        A faint horizontal line, if any.
    lowest
        Least y shown, if any.
    """

    title: str
    xlabel: str
    ylabel: str
    lines: dict[str, tuple[Array, Array]] = field(default_factory=dict)
    logarithmic: bool = False
    limit: float | None = None
    lowest: float | None = None


@drawn
def draw_panels(panels: Sequence[Panel], columns: int, heading: str = "") -> Figure:
    """Draw panels row by row.

    Parameters
    ----------
    panels
        At least one.
    columns
        Panels in a row.
    heading
        Line above the figure; empty for none.

    Returns
    -------
    bytes
        PNG.
    """
    rows = -(-len(panels) // columns)
    figure, axes = blank(columns, rows, 1.4 + 3.9 * columns, 0.5 + 3.1 * rows)
    for each in axes[len(panels) :]:
        each.set_visible(False)
    for at, panel in zip(axes, panels, strict=False):
        _draw(at, panel)
    if heading:
        figure.suptitle(heading)
    return figure


def _draw(axes: Axes, panel: Panel) -> None:
    if panel.limit is not None:
        axes.axhline(panel.limit, color=FAINT, linewidth=2.0, zorder=1)
    for k, (label, (x, y)) in enumerate(panel.lines.items()):
        colour = COLOURS[k % len(COLOURS)] if len(panel.lines) > 1 else MEASURED
        style = _STYLES[k % len(_STYLES)]
        plot = axes.loglog if panel.logarithmic else axes.plot
        # Every sample of a long simulation would only make the file large.
        step = max(1, x.size // _MOST_POINTS)
        plot(x[::step], y[::step], style, color=colour, label=label)
    if panel.logarithmic:
        # Over many decades there are hundreds of minor ticks, which nobody reads and all are drawn.
        axes.minorticks_off()
    axes.set_title(panel.title)
    axes.set_xlabel(panel.xlabel)
    axes.set_ylabel(panel.ylabel)
    if panel.lowest is not None:
        axes.set_ylim(bottom=panel.lowest)
    if len(panel.lines) > 1:
        # Below, where it hides no line.
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=len(panel.lines))
