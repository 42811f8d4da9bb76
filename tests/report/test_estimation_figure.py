"""Value axes of the figure of estimates."""

from __future__ import annotations

import matplotlib.figure
import numpy as np
import pytest

from hyst.online import Trajectory
from hyst.report import draw_estimates


@pytest.mark.parametrize(
    ("units", "expected"),
    [
        (("V", "um"), ["radius [V]", "weight [um/V]", "offset [um]"]),
        (("", "um"), ["radius", "weight", "offset [um]"]),
        # A ratio of equal units is a pure number.
        (("um", "um"), ["radius [um]", "weight", "offset [um]"]),
        (("", ""), ["radius", "weight", "offset"]),
    ],
)
def test_value_axes_carry_units(
    units: tuple[str, str], expected: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    labels: list[str] = []
    save = matplotlib.figure.Figure.draw

    def watched(self, *args, **kwargs):  # type: ignore[no-untyped-def]
        labels.extend(axes.get_ylabel() for axes in self.axes)
        return save(self, *args, **kwargs)

    monkeypatch.setattr(matplotlib.figure.Figure, "draw", watched)
    values = np.ones((3, 4)) * [1.0, 2.0, 3.0, 4.0]
    names = ("p0", "p[1]", "r[1]", "offset")
    trajectory = Trajectory(np.arange(3.0), names, values, 0.1 * values, np.zeros(3))
    draw_estimates({"": trajectory}, {}, "", units)
    assert labels == expected


def test_an_offset_does_not_flatten_the_weights_of_maps(monkeypatch: pytest.MonkeyPatch) -> None:
    limits: dict[str, tuple[float, float]] = {}
    save = matplotlib.figure.Figure.draw

    def watched(self, *args, **kwargs):  # type: ignore[no-untyped-def]
        limits.update({axes.get_title(loc="left"): axes.get_ylim() for axes in self.axes})
        return save(self, *args, **kwargs)

    monkeypatch.setattr(matplotlib.figure.Figure, "draw", watched)
    values = np.ones((3, 5)) * [1.0, 2.0, 3.0, 400.0, 0.9] + np.arange(3.0)[:, np.newaxis] / 10.0
    names = ("p0", "p[1]", "r[1]", "offset", "front[2]")
    trajectory = Trajectory(np.arange(3.0), names, values, 0.1 * values, np.zeros(3))
    draw_estimates({"": trajectory}, {}, "")
    low, high = limits["weights of maps"]
    # From 0.9 to 1.1 with a margin, whatever the offset is.
    assert high - low < 0.5
    assert low < 0.9 < 1.1 < high
    assert limits["offset"][0] > 300.0
