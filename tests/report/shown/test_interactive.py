"""Interactive figures hold what the others draw."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure
from shown_things import PANELS, RECORD, U

import hyst


@pytest.mark.parametrize("kind", PANELS)
def test_every_line_and_area_of_a_panel_is_there(kind: str, shown: dict[str, Any]) -> None:
    pytest.importorskip("plotly")
    for name in PANELS[kind]:
        drawn = shown[kind].plot(what=name)
        figure = shown[kind].plot(what=name, interactive=True)
        xlabel, ylabel = (
            axis.title.text.replace("&#36;", "$").replace("&lt;", "<").replace("&gt;", ">")
            for axis in (figure.layout.xaxis, figure.layout.yaxis)
        )
        assert (xlabel, ylabel) == (drawn.get_xlabel(), drawn.get_ylabel())
        for line in drawn.lines:
            if line.get_transform() != drawn.transData or line.get_marker() in ("|", "_"):
                continue  # across the whole panel, or the end of a bar of errors
            assert any(
                np.array_equal(np.asarray(trace.y, float), line.get_ydata(), equal_nan=True)
                for trace in figure.data
            ), (name, line)
        filled = [trace for trace in figure.data if trace.fill == "toself"]
        areas = [each for each in drawn.collections if hasattr(each, "get_datalim")]
        assert len(filled) >= len([each for each in areas if len(each.get_facecolor())]) * (
            name not in ("memory", "weights")
        )


def test_a_density_is_drawn_in_its_colours() -> None:
    pytest.importorskip("plotly")
    weights = np.tril(np.arange(1.0, 10.0).reshape(3, 3))
    model = hyst.Preisach(weights, [-1.0, 0.0, 1.0, 2.0])
    figure = model.plot(what="relays", u=[-1.0, 2.0, -1.0], interactive=True)
    cells = sum(int(np.isnan(np.asarray(trace.x, float)).sum()) for trace in figure.data)
    assert cells == 6  # of the lower triangle, each with a gap behind it
    assert len({trace.fillcolor for trace in figure.data}) == 6  # no two of one density


def test_names_from_a_file_are_neither_markup_nor_formulas() -> None:
    pytest.importorskip("plotly")
    figure = RECORD.plot(interactive=True)
    assert figure.layout.xaxis.title.text == "&#36;d&#36; &lt;b&gt; [V]"


def test_many_points_go_to_the_graphics_card() -> None:
    pytest.importorskip("plotly")
    long = hyst.Record(np.tile(U, 20), np.tile(RECORD.y, 20), 1e-3)
    assert long.plot(what="input", interactive=True).data[0].type == "scattergl"
    assert RECORD.plot(what="input", interactive=True).data[0].type == "scatter"


def test_axes_and_an_interactive_figure_are_one_too_many() -> None:
    with pytest.raises(hyst.InputError, match="axes and interactive=True are given"):
        RECORD.plot(Figure().subplots(), interactive=True)


def test_without_plotly_what_to_install_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "plotly", None)
    monkeypatch.setitem(sys.modules, "plotly.subplots", None)
    with pytest.raises(hyst.MissingExtraError, match=r"pip install 'hyst\[report\]'"):
        RECORD.plot(interactive=True)
