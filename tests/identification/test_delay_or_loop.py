"""Loops of one amplitude, of which a delay takes away what a family looks for."""

from __future__ import annotations

import numpy as np
import pytest

import hyst


def wide_saturating_loops() -> hyst.Record:
    """Three loops between two hyperbolic tangents, with no delay."""
    u = np.tile(np.sin(np.linspace(0.0, 2.0 * np.pi, 128, endpoint=False)), 3)
    flank = np.where(np.gradient(u) >= 0.0, u - 0.3, u + 0.3)
    return hyst.Record(80.0 * u, np.tanh(6.0 * flank) + 0.02 * u, dt=0.01)


def test_a_delay_that_may_be_none_makes_no_family_refuse() -> None:
    record = wide_saturating_loops()
    found = hyst.identify(record, family="jiles-atherton")
    assert found.delay == 0.0
    assert found.model == hyst.identify(record, family="jiles-atherton", delay=0).model
    assert found.delay_interval[1] > 1.0  # that it may be more is still said


@pytest.mark.parametrize("family", ["preisach", "two-envelope"])
def test_a_delay_that_may_be_none_spoils_no_fit(family: str) -> None:
    """With the delay of ten samples taken for granted, 12 % was left and the verdict was unfit."""
    found = hyst.identify(wide_saturating_loops(), family=family)
    assert found.delay == 0.0
    assert found.metrics["training"].rms_percent < 1.0
