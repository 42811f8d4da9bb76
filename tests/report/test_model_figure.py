"""Axes of the figure of a model say the units that follow from its stages."""

from __future__ import annotations

from typing import Any

import matplotlib.figure
import numpy as np
import pytest

from hyst import (
    Affine,
    DeadZone,
    GeneralizedPrandtlIshlinskii,
    LinearDynamics,
    ModifiedPrandtlIshlinskii,
    Operator,
    PrandtlIshlinskii,
    RambergOsgood,
    RateDependentPrandtlIshlinskii,
    Stop,
)
from hyst.report.model_figure import Labels, draw_model

PLAYS = PrandtlIshlinskii([0.5, 0.2], [1.0, 2.0], p0=0.5)
MAP = DeadZone([1.0, -0.2], [0.0, 1.0])
WEIGHT = "weight p [um/V]"
RISE = "rise of their output [um]"
U = 5.0 * np.sin(np.linspace(0.0, 10.0, 300))


def labels_of(model: Operator, monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, str]]:
    seen: list[tuple[str, str]] = []
    save = matplotlib.figure.Figure.draw

    def watched(figure: matplotlib.figure.Figure, *args: Any, **kwargs: Any) -> None:
        seen.extend((axes.get_xlabel(), axes.get_ylabel()) for axes in figure.axes)
        save(figure, *args, **kwargs)

    monkeypatch.setattr(matplotlib.figure.Figure, "draw", watched)
    draw_model(model, U, Labels("drive", "V", "position", "um"), {}, "")
    return seen


def test_plays_turn_the_unit_of_the_input_into_that_of_the_output(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    model = Affine(-1.0, 3.0) @ PLAYS
    assert labels_of(model, monkeypatch) == [
        ("radius r [V]", WEIGHT),
        ("rise of their input from rest [V]", RISE),
    ]


def test_maps_of_slope_one_keep_the_unit(monkeypatch: pytest.MonkeyPatch) -> None:
    before, *_ = labels_of(GeneralizedPrandtlIshlinskii(MAP, PLAYS), monkeypatch)
    assert before[0] == "drive [V]"
    assert before[1].endswith("times its input [V]")
    weights, _, after = labels_of(ModifiedPrandtlIshlinskii(PLAYS, MAP), monkeypatch)
    assert weights == ("radius r [V]", WEIGHT)
    assert after[0] == "output of the plays [um]"
    assert after[1].endswith("times its input [um]")


def test_a_unit_that_a_gain_has_changed_is_not_made_up(monkeypatch: pytest.MonkeyPatch) -> None:
    steep = DeadZone([3.0, -0.2], [0.0, 1.0])
    (_, bend), *plays = labels_of(GeneralizedPrandtlIshlinskii(steep, PLAYS), monkeypatch)
    assert bend.endswith("times its input")
    assert plays == [("radius r", "weight p"), ("rise of their input from rest", RISE)]


def test_plays_whose_radii_grow_are_drawn_at_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    model = RateDependentPrandtlIshlinskii([0.5, 0.2], [1.0, 2.0], 0.01, 1e-3, p0=0.5)
    assert labels_of(Affine(1.0, 3.0) @ model, monkeypatch) == [
        ("radius r [V]", WEIGHT),
        ("rise of their input from rest [V]", RISE),
    ]


def test_a_power_law_is_drawn_as_its_loading_curve(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[tuple[str, float]] = []
    save = matplotlib.figure.Figure.draw

    def watched(figure: matplotlib.figure.Figure, *args: Any, **kwargs: Any) -> None:
        axes = figure.axes[0]
        drawn.append((axes.get_title(loc="left"), float(axes.lines[0].get_ydata()[-1])))
        save(figure, *args, **kwargs)

    monkeypatch.setattr(matplotlib.figure.Figure, "draw", watched)
    u = np.array([-2.0, 2.0])
    draw_model(RambergOsgood(1.0, 3.0, 1.0), u, Labels("u", "", "y", ""), {}, "")
    # From rest to 2 the curve is c1 p + 2 c2 p^2 / 2 = 2 + 12, as the coefficient is 2^c3 c2.
    assert drawn == [("Loading curve", pytest.approx(14.0, rel=1e-12))]


def test_an_operator_without_a_portrait_of_its_own_is_drawn_as_its_loop(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert Stop(1.0).portrait().panels == ("loop",)
    # Alone, or between gains, the whole says more: its axes have the user's names and units.
    for model in (Stop(1.0), Affine(2.0, 1.0) @ Stop(1.0)):
        assert labels_of(model, monkeypatch) == [("drive [V]", "position [um]")]
    # Beside what shows something by itself it has its own panel.
    loop, (bend, _) = labels_of(MAP @ Stop(1.0), monkeypatch)
    assert loop == ("drive [V]", "its output [um]")
    assert bend == "its input [um]"


def test_dynamics_and_gains_leave_the_picture_to_the_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    lag = LinearDynamics.from_transfer_function([0.5], [1.0, -0.5], dt=1e-3)
    assert [x for x, _ in labels_of(lag @ PLAYS, monkeypatch)] == [
        "radius r [V]",
        "rise of their input from rest [V]",
    ]
    assert labels_of(lag, monkeypatch) == [("drive [V]", "position [um]")]
