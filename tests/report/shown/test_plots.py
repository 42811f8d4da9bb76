"""What records, models, results and comparisons draw: Axes in, Axes out, and nothing global."""

from __future__ import annotations

import io
import subprocess
import sys
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image
from shown_things import PANELS, RECORD, STAGE, U

import hyst


def pixels(png: bytes) -> NDArray[np.uint8]:
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB"))


@pytest.mark.parametrize("kind", PANELS)
def test_every_panel_stands_alone_on_axes_that_are_given(kind: str, shown: dict[str, Any]) -> None:
    for name in PANELS[kind]:
        axes = Figure().subplots()
        back = shown[kind].plot(axes, what=name)
        assert back is axes
        assert axes.get_title(loc="center") or axes.get_title(loc="left")
        assert axes.get_xlabel()
        assert axes.get_ylabel()
        assert axes.lines or axes.collections


@pytest.mark.parametrize("kind", PANELS)
def test_axes_of_a_new_figure_come_back_in_the_order_asked_for(
    kind: str, shown: dict[str, Any]
) -> None:
    names = PANELS[kind][::-1]
    panels = shown[kind].plot(what=names)
    alone = [shown[kind].plot(what=name) for name in names]
    assert len(panels) == len(names)
    assert all(isinstance(each, Axes) for each in panels)
    titles = [each.get_title(loc="left") for each in panels]
    assert titles == [each.get_title(loc="left") for each in alone]
    assert panels.figure is panels[-1].figure
    assert alone[0].figure is not panels.figure


def test_axes_of_subplots_are_taken_row_by_row(shown: dict[str, Any]) -> None:
    grid = Figure().subplots(2, 2)
    panels = shown["found"].plot(grid)
    assert list(panels) == list(grid.flat)
    # The band of an error is drawn beside the errors, in their unit.
    assert grid[1, 1].get_ylabel() == "error [um]"


def test_nothing_global_is_changed(shown: dict[str, Any]) -> None:
    before, figures = dict(mpl.rcParams), plt.get_fignums()
    png = shown["found"].plot()._repr_png_()
    assert png.startswith(b"\x89PNG")
    assert dict(mpl.rcParams) == before
    assert plt.get_fignums() == figures


def test_no_pyplot_is_loaded() -> None:
    program = (
        "import sys, hyst\nhyst.Record([0, 1, 0], [0, 1, 0.5], 0.1).plot()._repr_png_()\n"
        "assert 'matplotlib.figure' in sys.modules\nassert 'matplotlib.pyplot' not in sys.modules\n"
    )
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr


def test_a_notebook_shows_new_axes_but_not_those_of_a_caller_twice(shown: dict[str, Any]) -> None:
    one, several = RECORD.plot(), RECORD.plot(what=("input", "output"))
    assert pixels(one._repr_png_()).shape == (410, 520, 3)
    assert pixels(several._repr_png_()).shape == (410, 1040, 3)
    figure = Figure()
    assert RECORD.plot(figure.subplots(1, 2), what=("input", "output"))._repr_png_() is None
    assert not hasattr(RECORD.plot(figure.subplots()), "_repr_png_")


def test_what_a_caller_changes_is_laid_out_again_in_the_same_look() -> None:
    axes = RECORD.plot()
    axes.set_title("mine")
    axes.set_ylabel("two\nlines")
    axes.set_xlim(0.0, 1000.0)
    saved = io.BytesIO()
    axes.figure.savefig(saved, format="png")
    assert axes.get_title(loc="left") == "mine"
    assert axes.get_title(loc="center") == ""
    # All is inside the picture, and it is what a notebook shows but for the smoothing of its text.
    inside = pixels(saved.getvalue())[1:-1, 1:-1]
    assert inside.shape == (408, 518, 3)
    edges = [inside[:2], inside[-2:], inside[:, :2], inside[:, -2:]]
    assert all(int(each.min()) == 255 for each in edges)


def test_vectors_are_saved_too() -> None:
    saved = io.BytesIO()
    RECORD.plot().figure.savefig(saved, format="svg")
    assert b"<svg" in saved.getvalue()


def test_names_from_a_file_start_no_formula(shown: dict[str, Any]) -> None:
    axes = Figure().subplots()
    shown["comparison"].plot(axes, what="errors")
    texts = [each for each in axes.get_legend().get_texts() if "line $" in each.get_text()]
    assert texts
    assert not any(each.get_parse_math() for each in texts)
    assert not RECORD.plot(Figure().subplots()).xaxis.label.get_parse_math()


def test_a_result_is_drawn_over_other_records(shown: dict[str, Any]) -> None:
    other = hyst.Record(U[:700], STAGE(U[:700]), 1e-3, input_unit="V", output_unit="um")
    drawn = shown["found"].plot(what="residual", records=[other, RECORD])
    points = [line.get_ydata().size for line in drawn.lines if line.get_marker() == "."]
    assert points == [700, 1200]


def test_a_model_is_drawn_over_its_range_or_over_an_input(shown: dict[str, Any]) -> None:
    (line,) = shown["model"].plot(what="loop").lines
    drive = np.asarray(line.get_xdata())
    assert (drive.min(), drive.max()) >= (U.min(), U.min())
    assert drive.max() <= U.max()
    (line,) = hyst.Play(0.5).plot(what="loop", u=[0.0, 1.0, 0.0]).lines
    assert line.get_ydata().tolist() == [0.0, 0.5, 0.5]


def test_residuals_are_the_errors_that_tables_count(shown: dict[str, Any]) -> None:
    found = shown["found"]
    used = found.used[0]
    assert found.residuals.shape == (used.stop - used.start,)
    by_hand = (found.model(U) - RECORD.y)[used.start : used.stop]
    np.testing.assert_array_equal(found.residuals, by_hand)
    # The same sums in another order.
    rms = float(np.sqrt(np.mean(np.square(found.residuals))))
    assert rms == pytest.approx(found.metrics["training"].rms, rel=1e-12)


def test_a_result_is_saved_with_its_description(shown: dict[str, Any], tmp_path: Any) -> None:
    shown["found"].save(tmp_path / "model.json")
    again = hyst.load(tmp_path / "model.json")
    assert again == shown["found"].model
    assert again.description == shown["found"].description


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"axes": "loop"}, "axes is of type str; give axes of matplotlib"),
        ({"axes": 3, "what": ("loop", "input")}, "axes is of type int, and 2 panels"),
        ({"what": "lop"}, "what is 'lop'; choose one or more of loop, input, output"),
        ({"what": ()}, "what names no panel"),
    ],
)
def test_what_cannot_be_drawn_is_refused(arguments: dict[str, Any], said: str) -> None:
    with pytest.raises(hyst.InputError, match=said):
        RECORD.plot(**arguments)


def test_axes_of_another_kind_or_number_are_refused(shown: dict[str, Any]) -> None:
    polar = Figure().subplots(subplot_kw={"projection": "polar"})
    with pytest.raises(hyst.InputError, match="axes is of the projection 'polar'"):
        RECORD.plot(polar)
    with pytest.raises(hyst.InputError, match="axes has 3 axes, and 4 panels"):
        shown["found"].plot(Figure().subplots(1, 3))
    with pytest.raises(hyst.InputError, match="axes is axes of matplotlib, and 4 panels"):
        shown["found"].plot(Figure().subplots())
    with pytest.raises(hyst.InputError, match="records has a str"):
        shown["found"].plot(records=["a.csv"])
    other = hyst.Record(U, RECORD.y, 1e-3, output_unit="mm")
    with pytest.raises(hyst.InputError, match="output_unit of a record is 'mm' and of the model"):
        shown["found"].plot(records=other)
    with pytest.raises(hyst.InputError, match="records is empty"):
        shown["found"].plot(records=[])
    with pytest.raises(hyst.InputError, match="over which range it holds; give u"):
        hyst.Play(0.5).plot()
