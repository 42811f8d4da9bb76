"""Samples that are no measurements are passed over by what is looked for later."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_actuators import DT, plays, record, triangle

from hyst.diagnosis import Finding
from hyst.diagnosis.evidence import Evidence


def test_they_are_bridged_and_the_rest_is_as_it_was() -> None:
    u = triangle()
    clean = record(u, plays(u), 0.05)
    y = clean.y.copy()
    y[1000:1040] = 9.9e37
    evidence = Evidence((record(u, y),))
    assert evidence.usable(1) is evidence.records[0]
    samples = np.arange(1000, 1040)
    evidence.tell([Finding("values", "left out", "", record=1, samples=samples)])
    usable = evidence.usable(1)
    assert evidence.left_out(1).tolist() == samples.tolist()
    # A straight line from sample 999 to 1040.
    assert usable.y[1000:1040] == pytest.approx(
        np.interp(samples, [999, 1040], [clean.y[999], clean.y[1040]])
    )
    assert np.array_equal(np.delete(usable.y, samples), np.delete(clean.y, samples))
    # 40 of 3500 samples on a line instead of on a branch with noise.
    assert evidence.noise(1) == pytest.approx(0.05, rel=0.15)
    assert evidence.named("values", 1)[0].samples.size == 40
    assert not evidence.named("values", 2)


def test_warnings_leave_nothing_out_and_all_is_not_bridged() -> None:
    u = triangle(500.0, 1000)
    evidence = Evidence((record(u, plays(u), dt=DT),))
    evidence.tell([Finding("drift", "warning", "", record=1, samples=np.arange(5))])
    assert evidence.left_out(1).size == 0
    evidence.tell([Finding("values", "left out", "", record=1, samples=np.arange(1000))])
    assert evidence.usable(1) is evidence.records[0]
