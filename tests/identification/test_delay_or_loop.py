"""Loops of one amplitude, of which a delay takes away what a family looks for."""

from __future__ import annotations

import numpy as np
import pytest

import hyst


def saturating_loops() -> hyst.Record:
    """Three major loops of a magnet at rest in between: no time, and no delay."""
    u = np.tile(np.sin(np.linspace(0.0, 2.0 * np.pi, 128, endpoint=False)), 3)
    rising = np.gradient(u) >= 0.0
    flank = np.where(rising, u - 0.12, u + 0.12)
    scatter = 1e-3 * np.random.default_rng(0).normal(size=u.size)
    return hyst.Record(80.0 * u, np.tanh(6.0 * flank) + 0.02 * u + scatter, dt=0.01)


@pytest.mark.parametrize("family", ["jiles-atherton", "two-envelope"])
def test_a_delay_that_may_be_none_makes_no_family_refuse(family: str) -> None:
    record = saturating_loops()
    by_itself = hyst.identify(record, family=family)
    told = hyst.identify(record, family=family, delay=0)
    assert by_itself.delay == 0.0
    assert by_itself.model == told.model
    assert by_itself.delay_interval[1] > 1.0  # that it may be more is still said
