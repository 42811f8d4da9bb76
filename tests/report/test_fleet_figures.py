"""Figures of a fleet show odd devices where they are."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.figure import Figure

from hyst.report.fleet.figures import _histogram, _odd_ones


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_device_beyond_the_axis_stands_at_its_end_with_its_value(sign: float) -> None:
    axes = Figure().subplots()
    usual = sign * np.linspace(0.27, 0.33, 57)
    widest = _histogram(axes, usual)
    axes.axvline(sign)  # a limit of 1
    _odd_ones(axes, sign * np.array([0.35, 0.8, 3.433]), widest)
    low, high = axes.get_xlim()
    marked = [line for line in axes.lines if line.get_marker() == "v"]
    # 0.8 lies within the limit, which the axis shows anyway; 3.433 does not.
    np.testing.assert_array_equal(
        np.sort(marked[0].get_xdata()), np.sort(sign * np.array([0.35, 0.8]))
    )
    assert low <= sign <= high
    assert not low <= sign * 3.433 <= high
    assert [text.get_text() for text in axes.texts] == [f"{sign * 3.433:.3g}"]
    ends = [line for line in axes.lines if line.get_marker() in "<>"]
    assert [line.get_marker() for line in ends] == [">" if sign > 0.0 else "<"]


def test_where_all_odd_devices_are_far_out_the_axis_keeps_its_width() -> None:
    axes = Figure().subplots()
    widest = _histogram(axes, np.linspace(0.27, 0.33, 57))
    before = axes.get_xlim()
    _odd_ones(axes, np.array([3.433]), widest)
    assert axes.get_xlim() == before
    assert [text.get_text() for text in axes.texts] == ["3.43"]


@pytest.mark.parametrize("odd", [[1.0, 5.0], [3.0], [0.0]])
def test_odd_devices_alone_are_all_marked(odd: list[float]) -> None:
    axes = Figure().subplots()
    widest = _histogram(axes, np.array([]))
    _odd_ones(axes, np.array(odd), widest)
    low, high = axes.get_xlim()
    assert low < min(odd) <= max(odd) < high
    assert not axes.texts
