"""The look all figures share, and the door to matplotlib's file output.

Figures are made with the object-oriented interface: nothing here opens a window, keeps a figure
alive or depends on a display.
"""

from __future__ import annotations

import contextlib
import functools
import io
import warnings
from collections.abc import Callable, Iterator
from typing import Any, ParamSpec

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatter, LogFormatterMathtext

from hyst.report.figure_places import places_of
from hyst.report.palette import with_palette
from hyst.report.picture_pieces import written_places
from hyst.report.room import give_room

Parameters = ParamSpec("Parameters")

MEASURED = "#6b7280"
MODELLED = "#c2410c"
SECOND = "#1d4ed8"
FAINT = "#d1d5db"

_DOTS_PER_INCH = 100
_LOOK: Any = {
    "font.size": 10.0,
    "axes.titlesize": 10.5,
    "axes.titlelocation": "left",
    # Its place is set with that of the panels; looked for, it is measured again in each pass.
    "axes.titley": 1.0,
    "axes.labelsize": 10.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#4b5563",
    "axes.linewidth": 0.8,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e5e7eb",
    "grid.linewidth": 0.7,
    "legend.frameon": False,
    "legend.fontsize": 9.0,
    "figure.titlesize": 11.5,
    "figure.titleweight": "bold",
    "lines.linewidth": 1.2,
    # Without this a noisy line of a million samples can exceed the renderer's memory.
    "agg.path.chunksize": 20_000,
    # Names come from the user's file: a dollar sign in one starts no formula.
    "text.parse_math": False,
}


def drawn(draw: Callable[Parameters, Figure]) -> Callable[Parameters, bytes]:
    """Decorate a function that makes a figure, so that it gives the bytes of a PNG file.

    Parameters
    ----------
    draw
        Makes the figure with ``blank``.

    Returns
    -------
    callable
        The same in the shared look; equal arguments give equal bytes.
    """

    @functools.wraps(draw)
    def draw_png(*args: Parameters.args, **kwargs: Parameters.kwargs) -> bytes:
        with shared_look():
            figure = draw(*args, **kwargs)
            number_logarithmic_axes(figure)
            return png_of(figure)

    return draw_png


@contextlib.contextmanager
def shared_look() -> Iterator[None]:
    """Let what is made here have the look all figures share; outside nothing changes."""
    with mpl.rc_context(_LOOK), warnings.catch_warnings():
        # A sign the font does not have, in a name from the user's file, is drawn as a box.
        warnings.filterwarnings("ignore", message="Glyph .* missing")
        yield


def png_of(figure: Figure) -> bytes:
    """Lay a figure out and give its pixels; the file says where each panel is."""
    content = io.BytesIO()
    canvas: Any = FigureCanvasAgg(figure)
    own_room = figure.get_layout_engine() is None
    cells = give_room(figure, canvas.get_renderer()) if own_room else []
    # Not by savefig, which draws everything a second time in case it had to be laid out.
    canvas.draw()
    places = written_places(places_of(figure, cells)) if cells else None
    dots = (_DOTS_PER_INCH, _DOTS_PER_INCH)
    # Indices of few colours are written in a fifth of the time of red, green and blue.
    picture = with_palette(np.asarray(canvas.buffer_rgba()))
    picture.save(content, "png", compress_level=3, dpi=dots, pnginfo=places)
    return content.getvalue()


class _PlainNumbers(LogFormatter):
    """Labels of a logarithmic axis where matplotlib puts them, but not written as formulas."""

    def __call__(self, x: float, pos: int | None = None) -> str:
        return f"{x:g}" if super().__call__(x, pos) else ""


def number_logarithmic_axes(figure: Figure) -> None:
    """Write numbers at logarithmic axes: matplotlib's powers of ten are formulas, not parsed."""
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            if isinstance(axis.get_major_formatter(), LogFormatterMathtext):
                axis.set_major_formatter(_PlainNumbers())
            if isinstance(axis.get_minor_formatter(), LogFormatterMathtext):
                axis.set_minor_formatter(_PlainNumbers())


def blank(
    columns: int, rows: int, width: float, height: float, kind: type[Axes] = Axes
) -> tuple[Figure, list[Axes]]:
    """Make a figure with axes in a grid.

    Parameters
    ----------
    columns, rows
        Of the grid.
    width, height
        Of the figure, inches.
    kind
        Class of the axes.

    Returns
    -------
    figure : matplotlib.figure.Figure
    axes : list of matplotlib.axes.Axes
        Row by row.
    """
    figure = Figure(figsize=(width, height), dpi=_DOTS_PER_INCH)
    axes = figure.subplots(rows, columns, squeeze=False, subplot_kw={"axes_class": kind})
    return figure, [each for row in axes for each in row]


def with_unit(name: str, unit: str) -> str:
    """Label an axis with a name and its unit.

    Examples
    --------
    >>> with_unit("drive", "V"), with_unit("drive", "")
    ('drive [V]', 'drive')
    """
    return f"{name} [{unit}]" if unit else name


def ratio_unit(numerator: str, denominator: str) -> str:
    """Give the unit of a ratio: empty for a pure number, or where a unit is not known.

    Parameters
    ----------
    numerator, denominator
        Units of both; empty where not known.

    Examples
    --------
    >>> ratio_unit("um", "V"), ratio_unit("um", "um"), ratio_unit("", "V")
    ('um/V', '', '')
    """
    known = bool(numerator and denominator) and numerator != denominator
    return f"{numerator}/{denominator}" if known else ""
