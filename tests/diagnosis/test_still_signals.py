"""Channels that do not move are refused, and switches told as what they are."""

from __future__ import annotations

import numpy as np
import pytest
from faulty_records import diagnosed, good, only, record


@pytest.mark.parametrize("channel", ["input", "output"])
@pytest.mark.parametrize("samples", [1, 2, 1000])
def test_one_value_throughout(channel: str, samples: int) -> None:
    still, moving = np.full(samples, 3.25), np.arange(float(samples))
    given = record(still, moving) if channel == "input" else record(moving, still)
    found = [each for each in diagnosed(given).of("refusal") if channel in each.sentence]
    assert [each.name for each in found] == ["still signal"]
    assert "3.25" in found[0].sentence


def test_an_output_of_two_values_is_a_switch() -> None:
    u, y = good()
    finding = only(diagnosed(record(u, np.where(y > 30.0, 5.0, -1.0))), "still signal")
    assert finding.severity == "warning"
    assert "-1 um and 5 um" in finding.sentence


def test_an_output_that_stands_but_for_a_code_is_refused() -> None:
    u, _ = good()
    assert diagnosed(record(u, np.zeros(u.size))).of("refusal")
