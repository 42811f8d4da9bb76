"""Counters that start again are told from drives and switches that jump."""

from __future__ import annotations

import numpy as np
import pytest
from faulty_records import diagnosed, good, only, record

from hyst.diagnosis.values.wraps import wraps_in


@pytest.mark.parametrize("kind", ["triangle", "sine"])
@pytest.mark.parametrize("span", [40.0, 25.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_output(kind: str, span: float, sign: float) -> None:
    u, y = good(kind=kind)
    wrapped = np.mod(sign * y + 3.7, span)
    # By definition of the wrap: where the whole number of spans changes.
    jumps = np.flatnonzero(np.diff(np.floor_divide(sign * y + 3.7, span))) + 1
    finding = only(diagnosed(record(u, wrapped)), "wrapped counter")
    assert finding.severity == "refusal"
    assert finding.samples.tolist() == jumps.tolist()
    # A jump is the span less one step, and noise.
    assert finding.amounts["span"] == pytest.approx(span, rel=0.01)
    assert "output" in finding.sentence


def test_input() -> None:
    u, y = good()
    finding = only(diagnosed(record(np.mod(u, 64.0), y)), "wrapped counter")
    assert "input" in finding.sentence
    assert finding.amounts["span"] == pytest.approx(64.0, rel=0.01)


def test_a_sawtooth_drive_is_none() -> None:
    u = 100.0 * ((np.arange(4000) / 500.0) % 1.0)
    y = 0.6 * u
    assert wraps_in(u, y) is None
    assert wraps_in(y, u) is None


def test_one_jump_is_none() -> None:
    u, y = good()
    stepped = y + np.where(np.arange(y.size) < 2000, 0.0, 500.0)
    assert wraps_in(stepped, u) is None
