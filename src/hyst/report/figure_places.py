"""Where the panels of a drawn figure are, and what each shows in words."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from hyst.report.picture_pieces import Place, Places, rounded_out
from hyst.report.room import Cell

_POINTS = 72.0
_AROUND = 4.0  # pixels around a legend


def places_of(figure: Figure, cells: Sequence[tuple[Axes, Cell]]) -> Places:
    """Give what is where in a figure that was drawn.

    Parameters
    ----------
    figure
        The figure.
    cells
        As ``give_room`` gives them.
    """
    width, height = (round(each) for each in figure.bbox.size)
    panels = [
        Place(rounded_out([end * figure.dpi for end in cell], width, height), _words(axes))
        for axes, cell in cells
    ]
    if figure.legends:
        box = Bbox.union([each.get_window_extent() for each in figure.legends]).padded(_AROUND)
        ends = rounded_out((box.x0, height - box.y1, box.x1, height - box.y0), width, height)
        told = ", ".join(_names(figure.legends))
        panels.append(Place(ends, f"Legend: {told}", is_legend=True))
    letters = [
        float(each.get_fontsize()) * figure.dpi / _POINTS
        for each in figure.findobj(Text)
        if isinstance(each, Text) and each.get_text() and each.get_visible()
    ]
    columns = len({cell[0] for _, cell in cells})
    return Places(figure.get_suptitle(), min(letters, default=0.0), columns, tuple(panels))


def _words(axes: Axes) -> str:
    """Say what is drawn over what, and which lines have names."""
    x, y = axes.get_xlabel(), axes.get_ylabel()
    over = " over ".join(" ".join(each.split()) for each in (y, x) if each)
    title = " ".join(axes.get_title(loc="left").split())
    told = ": ".join(each for each in (title, over) if each)
    legend = axes.get_legend()
    names = _names([legend]) if legend is not None else []
    return f"{told}; {', '.join(names)}" if names else told


def _names(legends: Sequence[Legend]) -> list[str]:
    return [text.get_text() for each in legends for text in each.get_texts()]
