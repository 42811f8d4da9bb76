"""Nothing of a figure stands on anything else, or out of the picture."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text

from hyst.report.canvas import blank, drawn
from hyst.report.room import give_room


def panels(columns: int, rows: int, scale: float) -> tuple[Figure, list[Axes]]:
    """A grid whose axes have names, titles and values of a scale."""
    figure, axes = blank(columns, rows, 5.0 * columns, 0.5 + 3.0 * rows)
    for each in axes:
        each.plot(scale * np.array([-0.7, 1.3]), scale * np.array([-3.1, 2.6]))
        each.set(title="Error over input", xlabel="drive [V]", ylabel="position [m]")
    return figure, axes


def words(figure: Figure) -> list[Text]:
    """Titles, labels and powers of ten as they are drawn."""
    found = [figure.texts[0]] if figure.texts else []
    for each in figure.axes:
        found += [each.xaxis.label, each.yaxis.label]
        found += [each.xaxis.get_offset_text(), each.yaxis.get_offset_text()]
        found += [text for text in each.get_children() if isinstance(text, Text)]
    return [each for each in found if each.get_text()]


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e7])
@pytest.mark.parametrize(("columns", "rows"), [(1, 1), (2, 1), (2, 2), (1, 4)])
def test_words_stand_apart_and_inside(columns: int, rows: int, scale: float) -> None:
    boxes = {}

    @drawn
    def draw() -> Figure:
        figure, axes = panels(columns, rows, scale)
        figure.suptitle("Simulated data")
        axes[0].legend(["one"], loc="upper center", bbox_to_anchor=(0.5, -0.2))
        canvas = FigureCanvasAgg(figure)
        give_room(figure, canvas.get_renderer())
        canvas.draw()
        for number, text in enumerate(words(figure)):
            boxes[number, text.get_text()] = text.get_window_extent()
        for number, each in enumerate(axes):
            boxes[number, "panel"] = each.bbox.frozen()
        boxes[0, "legend"] = axes[0].get_legend().get_window_extent()
        boxes["figure"] = figure.bbox.frozen()
        return figure

    draw()
    whole = boxes.pop("figure")
    assert len(boxes) >= 4 * columns * rows + 2
    outside = [
        name
        for name, box in boxes.items()
        if box.union([whole, box]).size != pytest.approx(whole.size)
    ]
    assert outside == []
    pairs = combinations(boxes.items(), 2)
    assert [(a, b) for (a, one), (b, two) in pairs if one.overlaps(two)] == []


def test_panels_of_a_grid_are_equally_large() -> None:
    figure, axes = panels(2, 2, 1.0)
    axes[0].set_ylabel("two\nlines")
    axes[3].set_ylim(0.0, 123456789.0)
    give_room(figure, FigureCanvasAgg(figure).get_renderer())
    sizes = [each.get_position().size for each in axes]
    np.testing.assert_allclose(sizes, [sizes[0]] * 4, rtol=1e-12)
    assert sizes[0][0] > 0.3
    assert sizes[0][1] > 0.25
