"""A plot as SVG, with its words for those who do not see it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hyst.studio.drawing.axis import Axis

Array = NDArray[np.float64]

_ROW, _LETTER = 22, 9.0  # pixels of a row of the legend, and of a letter in the phone's size


@dataclass(frozen=True, eq=False)
class Line:
    """A line of a plot.

    Parameters
    ----------
    x, y
        Its points.
    name
        For the legend; empty for none.
    color
        Number of its colour in the style sheet, from 0.
    kind
        Solid or dashed, so that nobody needs the colour to tell lines apart; a band between two
        lines, the second one backwards.
    """

    x: Array
    y: Array
    name: str = ""
    color: int = 0
    kind: Literal["solid", "dashed", "band"] = "solid"


@dataclass(frozen=True, eq=False)
class Plot:
    """A plot.

    Parameters
    ----------
    lines
        From back to front.
    x_label, y_label
        Of the axes; empty for small plots without any.
    told
        What it shows, in words, for who does not see it.
    width, height
        Pixels of its own; the page scales it.
    logarithmic
        Whether both axes count powers of ten.
    more
        SVG drawn in front of the lines.
    """

    lines: Sequence[Line]
    x_label: str
    y_label: str
    told: str
    width: int = 560
    height: int = 340
    logarithmic: bool = False
    more: str = ""

    def axes(self) -> tuple[Axis, Axis]:
        """Give the axes of its lines."""
        left, right, top, bottom = self._margins()
        x = np.concatenate([each.x for each in self.lines]) if self.lines else np.zeros(0)
        y = np.concatenate([each.y for each in self.lines]) if self.lines else np.zeros(0)
        return (
            Axis.over(x, left, self.width - right, self.logarithmic),
            Axis.over(y, self.height - bottom, top, self.logarithmic),
        )

    def svg(self) -> str:
        """Give the picture."""
        across, up = self.axes()
        framed = bool(self.x_label or self.y_label)
        body = [_grid(across, up, self)] if framed else []
        body += [_drawn(each, across, up) for each in self.lines]
        body += [self.more]
        if framed:
            body += [_labels(self), _legend(self.lines, across)]
        return (
            f'<svg class="plot" viewBox="0 0 {self.width} {self.height}" role="img" '
            f'aria-label="{escape(self.told, quote=True)}">{"".join(body)}</svg>'
        )

    def _margins(self) -> tuple[int, int, int, int]:
        if not (self.x_label or self.y_label):
            return 2, 2, 2, 2
        rows = len(_legend_rows(self.lines, self.width))
        return 76, 14, 12 + _ROW * rows, 46


def _drawn(line: Line, across: Axis, up: Axis) -> str:
    x, y = across.pixels(line.x), up.pixels(line.y)
    inside = np.isfinite(x) & np.isfinite(y)
    points = np.round(np.column_stack([x, y])[inside], 1)
    if not len(points):
        return ""
    path = "M" + "L".join(f"{a:g} {b:g}" for a, b in points.tolist())
    return f'<path class="line c{line.color} {line.kind}" d="{path}"/>'


def _grid(across: Axis, up: Axis, plot: Plot) -> str:
    parts = []
    for x, label in across.ticks():
        parts.append(f'<path class="grid" d="M{x:.1f} {up.end}V{up.begin}"/>')
        parts.append(f'<text class="tick" x="{x:.1f}" y="{up.begin + 17}">{escape(label)}</text>')
    for y, label in up.ticks():
        parts.append(f'<path class="grid" d="M{across.begin} {y:.1f}H{across.end}"/>')
        where = f'x="{across.begin - 6}" y="{y + 4:.1f}"'
        parts.append(f'<text class="tick left" {where}>{escape(label)}</text>')
    return "".join(parts)


def _labels(plot: Plot) -> str:
    middle = plot.height / 2 - 16
    return (
        f'<text class="name" x="{plot.width / 2 + 24}" y="{plot.height - 8}">'
        f"{escape(plot.x_label)}</text>"
        f'<text class="name" transform="translate(15 {middle}) rotate(-90)">'
        f"{escape(plot.y_label)}</text>"
    )


def _legend(lines: Sequence[Line], across: Axis) -> str:
    """Name the lines above them, in as many rows as it takes."""
    parts = []
    for k, row in enumerate(_legend_rows(lines, int(across.end) + 14)):
        y, x = 17 + _ROW * k, across.begin
        for each in row:
            parts.append(f'<path class="line c{each.color} {each.kind} key" d="M{x} {y - 4}h24"/>')
            parts.append(f'<text class="legend" x="{x + 30}" y="{y}">{escape(each.name)}</text>')
            x += _room_of(each)
    return "".join(parts)


def _legend_rows(lines: Sequence[Line], width: int) -> list[list[Line]]:
    rows: list[list[Line]] = []
    left = 0.0
    for each in lines:
        if not each.name:
            continue
        if left < _room_of(each) or not rows:
            rows.append([])
            left = width - 90.0
        rows[-1].append(each)
        left -= _room_of(each)
    return rows


def _room_of(line: Line) -> float:
    return 46.0 + _LETTER * len(line.name)
