"""Numbers behind the figures and sentences."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from hyst.models import ModifiedPrandtlIshlinskii, PrandtlIshlinskii
from hyst.operators import Affine, DeadZone
from hyst.report.canvas import blank, drawn
from hyst.report.error_memory import autocorrelation
from hyst.report.model_figure import stages_with_signals
from hyst.report.tables import traits_table
from hyst.report.tracking_figure import draw_tracking
from hyst.report.words import error_sentence


def test_autocorrelation_is_the_sum_of_products() -> None:
    error = np.random.default_rng(5).normal(size=101) + 3.0
    centred = error - error.mean()
    by_definition = [
        sum(centred[k] * centred[k + lag] for k in range(101 - lag)) / sum(centred**2)
        for lag in range(40)
    ]
    # A transform of 256 points adds some rounding to numbers of order one.
    np.testing.assert_allclose(autocorrelation(error, 39), by_definition, atol=1e-13)


def test_autocorrelation_of_nothing_is_nothing() -> None:
    assert np.array_equal(autocorrelation(np.full(10, 2.0), 3), np.zeros(4))


def test_white_noise_is_called_white_and_drift_is_not() -> None:
    rng = np.random.default_rng(1)
    white = rng.normal(size=5000)
    drift = np.cumsum(white)
    assert "white sensor noise" in error_sentence(float(autocorrelation(white, 1)[1]), 5000)
    assert "not white" in error_sentence(float(autocorrelation(drift, 1)[1]), 5000)


def test_the_signal_is_followed_through_all_stages() -> None:
    plays = PrandtlIshlinskii(p=[0.5], r=[1.0], p0=1.0)
    bend = DeadZone([1.0, -0.3], [0.0, 2.0])
    model = Affine(2.0, 1.0) @ ModifiedPrandtlIshlinskii(plays, bend)
    u = np.array([0.0, 3.0, 1.0, 4.0])
    stages = list(stages_with_signals(model, u))
    assert [type(stage) for stage, _, _ in stages] == [PrandtlIshlinskii, DeadZone, Affine]
    assert np.array_equal(stages[0][1], u)
    for (_, _, after), (_, before, _) in pairwise(stages):
        assert np.array_equal(after, before)
    np.testing.assert_allclose(stages[-1][2], model(u), atol=1e-15)


def test_traits_are_named_and_answered() -> None:
    rows = {row[0]: row[1] for row in traits_table(PrandtlIshlinskii([1.0], [0.5])).rows}
    assert rows["rate independent"] == "yes"
    assert rows["invertible"] == "no"


def test_a_tracking_figure_shows_each_output() -> None:
    t = np.linspace(0.0, 6.0, 400)
    y = np.sin(t)

    def picture(outputs: dict[str, np.ndarray]) -> bytes:
        return draw_tracking(0.01, y, outputs, "stroke", "um", "")

    one = picture({"a": y + 0.1})
    assert one.startswith(b"\x89PNG")
    assert one != picture({"a": y + 0.1, "b": y - 0.1})


@pytest.mark.parametrize("name", ["$x_$", "a$b", "\\frac{", "\u4e2d\u6587"])
def test_any_name_can_be_drawn(name: str) -> None:
    def figure() -> object:
        figure, (axes,) = blank(1, 1, 4.0, 3.0)
        axes.plot([0.0, 1.0], [0.0, math.pi], label=name)
        axes.set_xlabel(name)
        axes.legend()
        figure.suptitle(name)
        return figure

    assert drawn(figure)().startswith(b"\x89PNG")  # type: ignore[arg-type]
