"""Interactive figures: what was drawn for matplotlib, read back and given to plotly.

So there is one drawing of everything. What a panel may be drawn with is listed below; a contract
test draws every panel and finds what is not.
"""

from __future__ import annotations

import html
import importlib
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection, QuadMesh
from matplotlib.colors import to_rgba
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.spines import Spine
from numpy.typing import NDArray

from hyst.errors import MissingExtraError
from hyst.report.canvas import shared_look
from hyst.report.shown.axes import Draw, new_axes

Array = NDArray[np.float64]

_COLUMNS = 2
_DASHES = {"-": "solid", "--": "dash", "-.": "dashdot", ":": "dot"}
_POINTS_TO_PIXELS = 1.5
_BETWEEN = 0.3  # of the height of a row
_LEVELS = 96
_MOST_IN_VECTORS = 15_000
_TURN = "rgba({:.0f},{:.0f},{:.0f},{:.3g})"


def interactive_figure(draws: Sequence[Draw]) -> Any:
    """Draw panels as one figure of plotly.

    Parameters
    ----------
    draws
        What draws each panel on axes of matplotlib.

    Raises
    ------
    MissingExtraError
        If plotly is not installed.
    """
    subplots = _door("plotly.subplots")
    axes = new_axes(len(draws))
    with shared_look():
        for draw, each in zip(draws, axes, strict=True):
            draw(each)
    columns = min(len(draws), _COLUMNS)
    rows = -(-len(draws) // columns)
    titles = [_written(each.get_title(loc="left")) for each in axes]
    figure = subplots.make_subplots(
        rows=rows,
        cols=columns,
        subplot_titles=titles,
        horizontal_spacing=0.12,
        vertical_spacing=_BETWEEN / rows,
    )
    for number, each in enumerate(axes):
        place = {"row": number // columns + 1, "col": number % columns + 1}
        for trace in _traces(each, f"panel{number}"):
            figure.add_trace(trace, **place)
        figure.update_xaxes(title_text=_written(each.get_xlabel()), range=each.get_xlim(), **place)
        figure.update_yaxes(title_text=_written(each.get_ylabel()), range=each.get_ylim(), **place)
    figure.update_layout(
        width=160 + 480 * columns,
        height=80 + 360 * rows,
        margin={"t": 60, "b": 60, "l": 70, "r": 20},
        template="plotly_white",
        hovermode="closest",
    )
    return figure


def _door(module: str) -> Any:
    """Import plotly: only here, and only when it is used."""
    try:
        return importlib.import_module(module)
    except ImportError as missing:
        raise MissingExtraError(
            "interactive figures need plotly, which is not installed; pip install 'hyst[report]'"
        ) from missing


def _traces(axes: Axes, group: str) -> Iterator[Any]:
    """Give what stands on axes, what is below first."""
    artists = [each for each in axes.get_children() if _is_drawn(each, axes)]
    read = [
        (str(each.get_label()), settings)
        for each in sorted(artists, key=lambda artist: artist.get_zorder())
        for settings in _reader(each)(each, axes)
    ]
    # All in one way: what is drawn by the graphics card is never below what is not.
    many = sum(len(settings["x"]) for _, settings in read) > _MOST_IN_VECTORS
    kind = getattr(_door("plotly.graph_objects"), "Scattergl" if many else "Scatter")
    for label, settings in read:
        named = bool(label) and not label.startswith("_")
        name = _written(label) if named else ""
        yield kind(name=name, showlegend=named, legendgroup=group, **settings)


def _is_drawn(artist: Artist, axes: Axes) -> bool:
    frame = artist is axes.patch or isinstance(artist, Spine)
    return isinstance(artist, tuple(_READERS)) and not frame and artist.get_visible()


def _reader(artist: Artist) -> Callable[[Any, Axes], Iterator[dict[str, Any]]]:
    return next(read for kind, read in _READERS.items() if isinstance(artist, kind))


def _of_line(line: Line2D, axes: Axes) -> Iterator[dict[str, Any]]:
    x, y = _in_data(line, axes)
    alpha = 1.0 if line.get_alpha() is None else line.get_alpha()
    colour = _colour(line.get_color(), alpha)
    dash = _DASHES.get(str(line.get_linestyle()))
    marker = str(line.get_marker())
    marked = marker not in ("None", "none", "", " ")
    mode = "+".join(["lines"] * (dash is not None) + ["markers"] * marked)
    if not mode:
        return
    settings: dict[str, Any] = {"x": x, "y": y, "mode": mode}
    if dash is not None:
        width = _POINTS_TO_PIXELS * line.get_linewidth()
        settings["line"] = {"color": colour, "width": width, "dash": dash}
    if marked:
        size = line.get_markersize() * (0.7 if marker == "." else 1.0) * _POINTS_TO_PIXELS
        settings["marker"] = {"color": colour, "size": max(size, 2.0)}
        if marker in "|_":
            settings["marker"]["symbol"] = "line-ns-open" if marker == "|" else "line-ew-open"
    yield settings


def _of_lines(lines: Any, axes: Axes) -> Iterator[dict[str, Any]]:
    gap = np.full((1, 2), np.nan)
    joined = np.concatenate([each for s in lines.get_segments() for each in (np.asarray(s), gap)])
    colour = _colour(lines.get_color()[0], None)
    width = _POINTS_TO_PIXELS * float(lines.get_linewidth()[0])
    line = {"color": colour, "width": width}
    yield {"x": joined[:, 0], "y": joined[:, 1], "mode": "lines", "line": line}


def _of_areas(areas: PolyCollection, axes: Axes) -> Iterator[dict[str, Any]]:
    for path in areas.get_paths():
        yield _area(path.vertices, areas.get_facecolor()[0])


def _of_patch(patch: Patch, axes: Axes) -> Iterator[dict[str, Any]]:
    to_data = patch.get_transform() - axes.transData
    yield _area(to_data.transform(patch.get_path().vertices), patch.get_facecolor())


def _of_mesh(mesh: Any, axes: Axes) -> Iterator[dict[str, Any]]:
    """Give cells by their colour, in so many steps: plotly has no mesh of any four corners."""
    corners = np.asarray(mesh.get_coordinates())
    cells = np.stack(
        [corners[:-1, :-1], corners[1:, :-1], corners[1:, 1:], corners[:-1, 1:]], axis=2
    ).reshape(-1, 4, 2)
    values = np.ma.ravel(np.ma.asarray(mesh.get_array()))
    level = np.round(np.ma.filled(mesh.norm(values), np.nan) * _LEVELS)
    gap = np.full((1, 2), np.nan)
    for each in np.unique(level[np.isfinite(level)]):
        outlines = [np.vstack([cell, cell[:1], gap]) for cell in cells[level == each]]
        yield _area(np.concatenate(outlines), mesh.cmap(each / _LEVELS))


def _area(corners: Any, colour: Any) -> dict[str, Any]:
    return {
        "x": np.asarray(corners)[:, 0],
        "y": np.asarray(corners)[:, 1],
        "mode": "lines",
        "fill": "toself",
        "fillcolor": _colour(colour, None),
        "line": {"width": 0},
        "hoverinfo": "skip",
    }


def _in_data(line: Line2D, axes: Axes) -> tuple[Array, Array]:
    """Give the points of a line in the units of both axes, as axhline's too."""
    points = np.column_stack([np.asarray(each, dtype=float) for each in line.get_data(orig=False)])
    if line.get_transform() != axes.transData:
        points = (line.get_transform() - axes.transData).transform(points)
    return points[:, 0], points[:, 1]


def _colour(colour: Any, alpha: float | None) -> str:
    red, green, blue, own = to_rgba(colour, alpha)
    return _TURN.format(255 * red, 255 * green, 255 * blue, own)


def _written(text: str) -> str:
    """Write a text of a file so that it is neither markup nor a formula."""
    return html.escape(text).replace("$", "&#36;")


_READERS: dict[type[Artist], Callable[[Any, Axes], Iterator[dict[str, Any]]]] = {
    Line2D: _of_line,
    LineCollection: _of_lines,
    QuadMesh: _of_mesh,
    PolyCollection: _of_areas,
    Patch: _of_patch,
}
