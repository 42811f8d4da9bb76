"""Plots stay small, cover what all samples would cover, and say what they show."""

import re

import numpy as np
import pytest

from hyst.studio.drawing.axis import Axis
from hyst.studio.drawing.extremes import extreme_samples
from hyst.studio.drawing.plot import Line, Plot


@pytest.mark.parametrize("size", [1_000_003, 1801, 1200, 999_999])
def test_a_record_is_drawn_by_the_extremes_of_its_stretches(size: int) -> None:
    y = np.random.default_rng(1).standard_normal(size)
    chosen = extreme_samples(400, y)
    assert chosen.size <= 802
    # Within any two stretches the drawn line reaches as far as all samples do.
    width = 2 * int(np.ceil(size / 400))
    for begin in range(0, size - width, width // 2):
        inside = chosen[(chosen >= begin) & (chosen < begin + width)]
        drawn, there = y[inside], y[begin + width // 4 : begin + 3 * width // 4]
        assert np.ptp(drawn) >= 0.5 * np.ptp(there)
    assert y[chosen].max() == y.max()
    assert y[chosen].min() == y.min()
    assert np.diff(chosen).max() < width


def test_a_spike_in_the_rest_behind_the_last_stretch_is_drawn() -> None:
    y = np.zeros(100_099)
    y[100_090] = 5.0
    assert 100_090 in extreme_samples(500, y)


def test_what_is_not_finite_is_passed_over() -> None:
    y = np.zeros(10_000)
    y[100], y[101], y[102] = np.nan, np.inf, 3.0
    assert 102 in extreme_samples(50, y)


def test_short_signals_are_drawn_whole() -> None:
    assert extreme_samples(500, np.zeros(10), np.zeros(10)).tolist() == list(range(10))


@pytest.mark.parametrize(
    ("low", "high", "labels"),
    [
        (0.0, 10.0, ["0", "2", "4", "6", "8", "10"]),
        (-1.0, 1.0, ["-1", "-0.5", "0", "0.5", "1"]),
        (
            -0.06,
            0.06,
            [
                "-0.06",
                "-0.05",
                "-0.04",
                "-0.025",
                "-0.02",
                "0",
                "0.02",
                "0.025",
                "0.04",
                "0.05",
                "0.06",
            ],
        ),
        (0.0, 150.0, ["0", "25", "50", "75", "100", "125", "150"]),
    ],
)
def test_ticks_stand_at_round_numbers(low: float, high: float, labels: list[str]) -> None:
    told = [label for _, label in Axis(low, high, 0.0, 100.0).ticks()]
    assert set(told) <= set(labels)
    assert len(told) >= 3


@pytest.mark.parametrize("span", [0.1, 0.125, 3.0, 7e4, 2e-5])
def test_labels_say_where_their_ticks_stand(span: float) -> None:
    axis = Axis(-0.4 * span, 0.6 * span, 0.0, 1000.0)
    for pixel, label in axis.ticks():
        assert float(label) == pytest.approx(axis.low + span * pixel / 1000.0, abs=1e-6 * span)


def test_an_axis_of_one_value_has_a_width() -> None:
    axis = Axis.over(np.array([3.0, 3.0]), 0.0, 100.0)
    assert axis.low < 3.0 < axis.high


def test_a_plot_is_small_and_tells_what_it_shows() -> None:
    y = np.sin(np.linspace(0, 9, 1_000_000))
    at = extreme_samples(500, y)
    svg = Plot((Line(at.astype(float), y[at], "a <b>"),), "x", "y", 'Loop "one" & <two>').svg()
    assert len(svg) < 40_000
    assert 'role="img" aria-label="Loop &quot;one&quot; &amp; &lt;two&gt;"' in svg
    assert "a &lt;b&gt;" in svg


def test_points_lie_where_their_values_are() -> None:
    svg = Plot((Line(np.array([0.0, 1.0]), np.array([0.0, 1.0])),), "", "", "", 104, 104).svg()
    path = re.search(r'd="M([\d.]+) ([\d.]+)L([\d.]+) ([\d.]+)"', svg)
    assert path is not None
    # Room of 2 pixels around, and of 4 % of the range inside that: 2 + 100 * 0.04 / 1.08.
    places = [float(each) for each in path.groups()]
    assert places == pytest.approx([5.7, 98.3, 98.3, 5.7], abs=0.05)


def test_nothing_is_drawn_of_what_is_not_finite() -> None:
    svg = Plot((Line(np.array([np.nan]), np.array([1.0])),), "", "", "nothing").svg()
    assert "<path" not in svg
