"""Room around the panels of a figure for what stands there: measured once, and placed at once.

Matplotlib's constrained layout measures every panel four times, and labels again when it draws,
which is two fifths of the time of a figure; and a title whose place is fixed, so that it need not
be looked for in each of these passes, stands on the power of ten of the axis below it.
"""

from __future__ import annotations

import textwrap
from dataclasses import dataclass

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox, ScaledTranslation
from numpy.typing import NDArray

_EDGE, _BETWEEN = 0.05, 0.16  # inches
_LINE = 1.25  # height of a line of text over the size of its letters
_LEAST = 0.2  # inches: a panel is never lost to what stands around it
_POINTS = 72.0


@dataclass
class Around:
    """What stands out of a panel on its four sides.

    Parameters
    ----------
    left, below, right, above
        Inches.
    """

    left: float = 0.0
    below: float = 0.0
    right: float = 0.0
    above: float = 0.0

    def hold(self, box: Bbox, panel: Bbox, dpi: float) -> None:
        """Grow so that ``box`` fits in.

        Parameters
        ----------
        box, panel
            Pixels.
        dpi
            Pixels an inch.
        """
        self.left = max(self.left, (panel.x0 - box.x0) / dpi)
        self.below = max(self.below, (panel.y0 - box.y0) / dpi)
        self.right = max(self.right, (box.x1 - panel.x1) / dpi)
        self.above = max(self.above, (box.y1 - panel.y1) / dpi)


Cell = tuple[float, float, float, float]


def give_room(figure: Figure, renderer: RendererAgg) -> list[tuple[Axes, Cell]]:
    """Set the places of all panels of a grid, of their labels and of their titles.

    Parameters
    ----------
    figure
        With axes in a grid, as ``blank`` makes it.
    renderer
        That of the canvas.

    Returns
    -------
    list of tuple
        Each panel, and left, upper, right and lower end of all that belongs to it: inches from the
        upper left corner of the figure.
    """
    figure.subplots_adjust(left=0.08, right=0.98, bottom=0.12, top=0.88, wspace=0.18, hspace=0.3)
    spans = [(each, each.get_subplotspec()) for each in figure.axes if each.get_visible()]
    cells = [(each, at.colspan.start, at.rowspan.start) for each, at in spans if at is not None]
    columns = [Around() for _ in range(1 + max(column for _, column, _ in cells))]
    rows = [Around() for _ in range(1 + max(row for _, _, row in cells))]
    for axes, at, down in cells:
        around = _measured(axes, renderer, figure.dpi)
        column, row = columns[at], rows[down]
        column.left, column.right = max(column.left, around.left), max(column.right, around.right)
        row.below, row.above = max(row.below, around.below), max(row.above, around.above)
    width, height = figure.get_size_inches()
    height -= _heading(figure) + _foot(figure, renderer)
    x, wide = _shared(width, [each.left for each in columns], [each.right for each in columns])
    y, high = _shared(height, [each.above for each in rows], [each.below for each in rows])
    whole, top, half = figure.get_figheight(), _heading(figure), 0.5 * _BETWEEN
    found = []
    for axes, at, down in cells:
        left, low, column, row = x[at], whole - top - y[down] - high, columns[at], rows[down]
        axes.set_position((left / width, low / whole, wide / width, high / whole))
        upper = top + max(y[down] - row.above - half, 0.0)
        lower = top + min(y[down] + high + row.below + half, height)
        found.append(
            (axes, (left - column.left - half, upper, left + wide + column.right + half, lower))
        )
    return found


def _shared(
    whole: float, before: list[float], after: list[float]
) -> tuple[NDArray[np.float64], float]:
    """Give where equally large panels begin, and how large they are, inches."""
    gaps = 2.0 * _EDGE + _BETWEEN * (len(before) - 1)
    size = max((whole - gaps - sum(before) - sum(after)) / len(before), _LEAST)
    ends = np.cumsum(np.add(before, after) + size + _BETWEEN)
    return _EDGE + np.append(0.0, ends[:-1]) + before, size


def _heading(figure: Figure) -> float:
    """Give the height of the line above a figure."""
    highs = [_lines(each.get_text()) * float(each.get_fontsize()) * _LINE for each in figure.texts]
    return 0.02 * figure.get_figheight() + max(highs) / _POINTS if highs else 0.0


def _foot(figure: Figure, renderer: RendererAgg) -> float:
    """Give the height of legends of the whole figure, which stand below all panels."""
    boxes = [each.get_window_extent(renderer) for each in figure.legends]
    return max((float(each.height) / figure.dpi + 2.0 * _EDGE for each in boxes), default=0.0)


def _lines(text: str) -> int:
    return text.count("\n") + 1 if text else 0


def _measured(axes: Axes, renderer: RendererAgg, dpi: float) -> Around:
    """Place labels and title of a panel, and give what stands around it."""
    around, panel = Around(), axes.bbox
    for axis in (axes.xaxis, axes.yaxis):
        _place_label(axis, around, renderer, dpi)
    # Above the panel stands, as yet, at most the power of ten of its vertical axis.
    power = around.above if axes.yaxis.get_offset_text().get_text() else 0.0
    title = axes.get_title(loc="left")
    if title:
        title = _broken(title, axes.title.get_window_extent(renderer).width, panel.width)
        pad = float(mpl.rcParams["axes.titlepad"]) + power * _POINTS
        axes.set_title(title, loc="left", pad=pad)
        size = float(axes.title.get_fontsize()) * _LINE
        around.above = max(around.above, (pad + _lines(title) * size) / _POINTS)
    legend = axes.get_legend()
    if legend is not None and legend.get_bbox_to_anchor() is not panel:
        around.hold(legend.get_window_extent(renderer), panel, dpi)
    for beside in axes.child_axes:
        box = beside.get_tightbbox(renderer)
        if box is not None:
            around.hold(box, panel, dpi)
    return around


def _broken(text: str, length: float, room: float) -> str:
    """Break a text at spaces into the lines that keep it beside its panel, ``room`` long."""
    if length <= room or "\n" in text:
        return text
    return textwrap.fill(text, max(int(len(text) * room / length), 1), break_long_words=False)


def _place_label(axis: Axis, around: Around, renderer: RendererAgg, dpi: float) -> None:
    """Set the label of an axis beside its numbers, where it is not looked for again."""
    axes, label, upright = axis.axes, axis.label, axis is axis.axes.yaxis
    # The power of ten of the horizontal axis stands at the end of the line that its label is in.
    unmeasured = [label] if upright else [label, axis.get_offset_text()]
    for each in unmeasured:
        each.set_visible(False)
    axis.set_label_coords(0.5, 0.5)
    box = axis.get_tightbbox(renderer)
    for each in unmeasured:
        each.set_visible(True)
    if box is not None:
        around.hold(box, axes.bbox, dpi)
    if not label.get_text():
        return
    extent = label.get_window_extent(renderer)
    length, room = (extent.height, axes.bbox.height) if upright else (extent.width, axes.bbox.width)
    label.set_text(_broken(label.get_text(), length, room))
    pad = axis.labelpad / _POINTS
    thick = _lines(label.get_text()) * float(label.get_fontsize()) * _LINE / _POINTS
    numbers = around.left if upright else around.below
    shift = (-numbers - pad, 0.0) if upright else (0.0, -numbers - pad)
    placed = axes.transAxes + ScaledTranslation(*shift, axes.figure.dpi_scale_trans)
    axis.set_label_coords(*((0.0, 0.5) if upright else (0.5, 0.0)), transform=placed)
    if upright:
        around.left += pad + thick
    else:
        around.below += pad + thick
