"""A sensor at both its ends shows no turn of its input, and so nothing of a delay."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_actuators import DT, plays, triangle

import hyst


@pytest.mark.parametrize("unit", [1.0, 2.0**-8])
@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_an_output_clipped_at_both_ends_is_not_ahead(unit: float, noise: float) -> None:
    u = triangle()
    y = plays(u) + noise * np.random.default_rng(4).standard_normal(u.size)
    low, high = y.min() + 0.1 * np.ptp(y), y.max() - 0.25 * np.ptp(y)
    found = hyst.diagnose(hyst.Record(u, unit * np.clip(y, low, high), DT))
    assert len(found.named("saturated sensor")) == 2
    assert not found.named("output ahead of input")
    assert not found.named("delay or radius")
