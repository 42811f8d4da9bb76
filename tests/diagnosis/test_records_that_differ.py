"""Records of which one is, or all are, of another actuator."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_actuators import NESTED, Array, bent, plays, record, sine, through, triangle, warned

import hyst


@pytest.mark.parametrize("odd", [1, 7, 12])
def test_record_with_another_gain_is_named(odd: int) -> None:
    u = through(NESTED)
    records = [
        record(u, plays(u, 0.53 if which == odd else 0.5), 0.05, seed=which)
        for which in range(1, 13)
    ]
    (found,) = hyst.diagnose(records).named("records that differ")
    assert found.record == odd
    # 0.53 and about 0.8 of the plays' weights of 0.19 against 0.5 and the same.
    assert found.amounts["gain"] == pytest.approx(0.682 / 0.652, abs=0.015)
    assert f"record {odd} " in found.sentence


def test_record_with_a_wider_loop_is_named() -> None:
    u = triangle()
    records = [
        record(u, plays(u, 0.5, (0.1, 0.06, 0.06 if which == 2 else 0.03)), 0.05, seed=which)
        for which in range(5)
    ]
    (found,) = hyst.diagnose(records).named("records that differ")
    assert found.record == 3
    assert found.amounts["width"] > 1.1 * found.amounts["width of others"]


def test_twelve_actuators_are_no_one_actuator() -> None:
    rng = np.random.default_rng(9)
    u = sine()
    records = []
    for which in range(12):
        weights = tuple(np.array([0.1, 0.06, 0.03]) * (1.0 + 0.05 * rng.standard_normal(3)))
        records.append(record(u, plays(u, 0.5, weights), 0.02, seed=which))
    (found,) = hyst.diagnose(records).named("records that differ")
    assert found.record == 0
    assert found.amounts["narrowest"] < found.amounts["widest"]


@pytest.mark.parametrize("noise", [0.0, 0.05, 2.0])
@pytest.mark.parametrize("u", [triangle(), through(NESTED), sine(1000.0 / 3.0)])
def test_records_of_one_actuator_agree(u: Array, noise: float) -> None:
    records = [record(u, bent(u), noise, seed=which) for which in range(4)]
    records.append(record(triangle(500.0, 3000, 0.0, 60.0), bent(triangle(500.0, 3000, 0.0, 60.0))))
    assert "records that differ" not in warned(records)
