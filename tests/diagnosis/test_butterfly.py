"""An output that falls while the input rises on a large part."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_actuators import (
    DT,
    bent,
    friction,
    plays,
    record,
    sine,
    switching,
    triangle,
    warned,
)

import hyst


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("drive", [triangle, sine])
@pytest.mark.parametrize("noise", [0.0, 0.1])
def test_wings_either_way_up(drive: object, sign: float, noise: float) -> None:
    u = drive(500.0, 3000, -100.0, 100.0)  # type: ignore[operator]
    y = sign * (np.abs(switching(u)) * 3.0 + 0.02 * u)
    (found,) = hyst.diagnose(record(u, y, noise)).named("butterfly")
    # The wings are about as long on either side.
    assert found.amounts["share"] == pytest.approx(0.5, abs=0.15)


def test_loops_that_only_look_like_it_are_none() -> None:
    u = sine(200.0, 2000)
    late = np.roll(plays(u), 20)  # 36 degrees: the output still falls where the input rises
    for y in (late, 50.0 - bent(u), friction(u), switching(u), plays(u) ** 2):
        assert "butterfly" not in warned(record(u, y, 0.02))


def test_noise_alone_is_none() -> None:
    u = triangle(40.0, 1000)
    noise = np.random.default_rng(6).standard_normal(u.size)
    assert "butterfly" not in warned(hyst.Record(u, noise, DT))
