"""Stretches without a measurement are told from plants that stand still."""

from __future__ import annotations

import numpy as np
import pytest
from faulty_records import diagnosed, good, only, record
from healthy_records import triangle_wave

import hyst

PLACES = [1080, 1820, 2600]  # on slopes of the triangle, away from its turns


@pytest.mark.parametrize("length", [15, 40])
def test_last_value_held(length: int) -> None:
    u, y = good(seed=4)
    for place in PLACES:
        y[place : place + length] = y[place - 1]
    finding = only(diagnosed(record(u, y)), "dropouts")
    assert finding.severity == "left out"
    # The first of them is a measurement and belongs to the stretch by its value.
    expected = np.concatenate([np.arange(each - 1, each + length) for each in PLACES])
    assert finding.samples.tolist() == expected.tolist()
    assert finding.amounts["count"] == 3


@pytest.mark.parametrize("value", [0.0, -20.0, 100.0])
@pytest.mark.parametrize("length", [3, 15])
def test_another_value_in_between(value: float, length: int) -> None:
    u, y = good(seed=5)
    for place in PLACES:
        y[place : place + length] = value
    finding = only(diagnosed(record(u, y)), "dropouts")
    expected = np.concatenate([np.arange(each, each + length) for each in PLACES])
    assert finding.samples.tolist() == expected.tolist()


def test_too_many_refuse_the_record() -> None:
    u, y = good(samples=8000, period=8000.0)
    for place in range(200, 7800, 100):
        y[place : place + 25] = -50.0
    finding = only(diagnosed(record(u, y)), "dropouts")
    assert finding.severity == "refusal"


@pytest.mark.parametrize("period", [1000.0, 97.3])
def test_a_play_that_stands_still_is_none(period: float) -> None:
    u = triangle_wave(4000, period, 50.0)
    found = diagnosed(record(u, hyst.Play(8.0)(u)))
    assert not found.named("dropouts")
    assert found.left_out(1).size == 0


def test_a_channel_that_stands_with_the_input_is_none() -> None:
    u = np.round(triangle_wave(4000, 2000.0, 50.0) / 5.0) * 5.0
    assert not diagnosed(record(u, hyst.Play(2.0)(u))).named("dropouts")
