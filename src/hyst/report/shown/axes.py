"""Axes in, Axes out: where pictures are drawn that a caller keeps.

Nothing here knows pyplot: figures made here are in no list, so that none is left open, and what
they look like is theirs alone. A notebook shows them because they say what they look like.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Literal, overload

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg, RendererAgg
from matplotlib.figure import Figure
from matplotlib.layout_engine import LayoutEngine
from matplotlib.text import Text

from hyst.errors import InputError
from hyst.report.canvas import blank, number_logarithmic_axes, png_of, shared_look
from hyst.report.room import give_room

Draw = Callable[[Axes], None]

_COLUMNS = 2
_LOOK_OF_GRID: Any = {"color": "#e5e7eb", "linewidth": 0.7}


class ShownAxes(Axes):
    """Axes that a notebook shows as the figure they are in, with the title where it was."""

    def set_title(
        self,
        label: str,
        fontdict: dict[str, Any] | None = None,
        loc: Literal["left", "center", "right"] | None = None,
        pad: float | None = None,
        *,
        y: float | None = None,
        **kwargs: Any,
    ) -> Text:
        """Set the title, at the left unless ``loc`` says otherwise; see matplotlib's."""
        return super().set_title(label, fontdict, loc or "left", pad, y=y, **kwargs)

    def _repr_png_(self) -> bytes | None:
        return _png_in_look(Panels([self]).figure)


class Panels(tuple[Axes, ...]):
    """Axes of several panels, in the order in which they were asked for.

    A notebook shows them as their figure, unless the axes were given: then it is the caller's.
    """

    __slots__ = ()

    @property
    def figure(self) -> Figure:
        """The figure of the first of them."""
        holding = self[0].figure  # which may be a part of a figure
        assert holding is not None, "axes that were drawn on are in a figure"
        return holding.figure

    def _repr_png_(self) -> bytes | None:
        return _png_in_look(self.figure) if isinstance(self[0], ShownAxes) else None


class Room(LayoutEngine):
    """Gives panels the room they need whenever their figure is drawn."""

    _adjust_compatible = True
    _colorbar_gridspec = False

    def execute(self, fig: Any) -> None:
        """Lay out the figure ``fig``, if it still has panels in a grid."""
        if any(each.get_subplotspec() is not None for each in fig.axes if each.get_visible()):
            # Of its own: the canvas of the moment may write files of vectors.
            with shared_look():
                renderer: Any = RendererAgg
                give_room(fig, renderer(*fig.bbox.size, fig.dpi))


@overload
def drawn_on(axes: Any, what: str, draws: Sequence[Draw]) -> Axes: ...
@overload
def drawn_on(axes: Any, what: Sequence[str], draws: Sequence[Draw]) -> Panels: ...
def drawn_on(axes: Any, what: str | Sequence[str], draws: Sequence[Draw]) -> Axes | Panels:
    """Draw panels on axes that are given, or on those of a new figure.

    Parameters
    ----------
    axes
        Axes for a panel, a sequence of as many as there are panels for several; None for a new
        figure.
    what
        The panels by name: the name of one, or a sequence of names.
    draws
        What draws each.

    Returns
    -------
    matplotlib.axes.Axes or Panels
        The axes of the panel where ``what`` is a name; of the panels where it is a sequence.

    Raises
    ------
    InputError
        If ``axes`` is neither, or has another number of them.
    """
    taken = new_axes(len(draws)) if axes is None else _given(axes, what, len(draws))
    if axes is None:
        with shared_look():
            for draw, each in zip(draws, taken, strict=True):
                draw(each)
            number_logarithmic_axes(_figure_of(taken))
    else:
        for draw, each in zip(draws, taken, strict=True):
            draw(each)
            _write_plainly(each)
    return taken[0] if isinstance(what, str) else Panels(taken)


def new_axes(count: int) -> list[Axes]:
    """Give ``count`` axes in a new figure that pyplot does not know."""
    columns = min(count, _COLUMNS)
    rows = -(-count // columns)
    with shared_look():
        figure, axes = blank(columns, rows, 5.2 * columns, 0.4 + 3.7 * rows, ShownAxes)
        for each in axes[count:]:
            each.remove()
        for each in axes:
            # What is drawn later, outside this look, keeps it.
            each.grid(visible=True, **_LOOK_OF_GRID)
        FigureCanvasAgg(figure)
        figure.set_layout_engine(Room())
    return axes[:count]


def _given(axes: Any, what: str | Sequence[str], count: int) -> list[Axes]:
    if isinstance(what, str):
        return [_as_axes(axes)]
    if isinstance(axes, str | bytes) or not hasattr(axes, "__len__"):
        several = "axes of matplotlib" if isinstance(axes, Axes) else _kind(axes)
        raise InputError(
            f"axes is {several}, and {count} panels are to be drawn; give a sequence of {count} "
            'axes, or name one panel, as what="loop"'
        )
    listed = list(getattr(axes, "flat", axes))  # plt.subplots gives an array of rows
    if len(listed) != count:
        raise InputError(
            f"axes has {len(listed)} axes, and {count} panels are to be drawn; give one for each"
        )
    return [_as_axes(each) for each in listed]


def _as_axes(axes: Any) -> Axes:
    if not isinstance(axes, Axes):
        raise InputError(
            f"axes is {_kind(axes)}; give axes of matplotlib, as those of plt.subplots()"
        )
    if axes.name != "rectilinear":
        raise InputError(
            f"axes is of the projection {axes.name!r}; give plain axes, as those of plt.subplots()"
        )
    return axes


def _kind(value: Any) -> str:
    return f"of type {type(value).__name__}"


def _write_plainly(axes: Axes) -> None:
    """Let names from a file start no formula: a dollar sign in one is a dollar sign."""
    legend = axes.get_legend()
    lines = {each.get_label() for each in axes.get_lines()}
    named = [] if legend is None else [t for t in legend.get_texts() if t.get_text() in lines]
    for text in (axes.xaxis.label, axes.yaxis.label, *named):
        text.set_parse_math(False)


def _figure_of(axes: Sequence[Axes]) -> Figure:
    return Panels(axes).figure


def _png_in_look(figure: Any) -> bytes:
    with shared_look():
        return png_of(figure)
