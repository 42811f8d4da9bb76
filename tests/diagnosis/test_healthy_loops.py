"""Healthy records are warned of nothing but of what they lack; odd ones break nothing."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_actuators import (
    DT,
    NESTED,
    Actuator,
    Array,
    bent,
    friction,
    plays,
    record,
    sine,
    switching,
    through,
    triangle,
    warned,
)

import hyst

DRIVES = {
    "triangle": triangle(),
    "333.33": triangle(1000.0 / 3.0),
    "bipolar sine": sine(400.7, 4000, -50.0, 50.0),
    "few samples": sine(40.0, 1000),
    "two cycles": triangle(1000.0, 2001),
    "nested": through(NESTED),
    "decaying": hyst.signals.decaying_triangle(DT, 50.0, 200.0, cycles=10).u,
    "reversal curves": hyst.signals.forc(DT, 0.0, 100.0, 400.0, curves=12).u,
    "multisine": hyst.signals.multisine(
        DT, 2000, amplitude=50.0, band=(1.0, 20.0), periods=3, seed=2
    ).u,
    "stairs": hyst.signals.staircase(DT, 0.0, 100.0, 1000.0, steps=10, hold=0.1).u,
    "sweep": 50.0 * np.sin(2.0 * np.pi * np.cumsum(np.geomspace(1.0, 20.0, 6000)) * DT),
    "random": through([0.0, *np.random.default_rng(5).uniform(0.0, 100.0, 30)], 200),
    "amplitudes": np.concatenate(
        [a * np.sin(2.0 * np.pi * np.arange(1500) / 500) for a in (20.0, 40.0, 60.0, 80.0)]
    ),
    "rates": np.concatenate([triangle(1000.0, 2000), triangle(300.0, 1500), triangle(100.0, 1000)]),
}


@pytest.mark.parametrize("u", DRIVES.values(), ids=DRIVES.keys())
@pytest.mark.parametrize("actuator", [plays, bent, switching, friction])
def test_no_false_alarm(u: Array, actuator: Actuator) -> None:
    y = actuator(u)
    expected = {"run direction"} if actuator is friction else set()
    for seed, share in enumerate((0.0, 0.003, 0.05)):
        found = warned(record(u, y, share * float(np.ptp(y)), seed))
        assert found <= expected, share


@pytest.mark.parametrize("samples", [1, 2, 3, 5, 17, 64])
def test_short_and_odd_records_break_nothing(samples: int) -> None:
    rng = np.random.default_rng(samples)
    k = np.arange(samples)
    signals = [np.ones(samples), 1.0 * k, (-1.0) ** k, np.sin(k), rng.standard_normal(samples)]
    for u in signals:
        for y in signals:
            found = hyst.diagnose(hyst.Record(u, y, DT))
            assert isinstance(found.summary(), str)
            found.to_dict()


def test_extreme_sizes_break_nothing() -> None:
    u, y = triangle(), plays(triangle())
    for scale in (1e300, 1e-300):
        assert warned(hyst.Record(scale * u, scale * y, DT)) == set()
    assert warned(hyst.Record(u + 1e6, y + 1e9, DT)) == set()


@pytest.mark.parametrize(
    ("of_u", "of_y", "of_time"), [(2.0**10, 2.0**-20, 1.0), (2.0**-7, 2.0**30, 2.0**-5)]
)
def test_units_change_nothing_but_the_numbers(of_u: float, of_y: float, of_time: float) -> None:
    u = through(NESTED)
    t = np.arange(u.size) * DT
    y = plays(u) + 0.5 * t + 0.5 * np.sin(2.0 * np.pi * 50.0 * t)
    y = y + 0.05 * np.random.default_rng(1).standard_normal(u.size)
    one = hyst.diagnose(hyst.Record(u, y, DT)).findings
    other = hyst.diagnose(hyst.Record(of_u * u, of_y * y, of_time * DT)).findings
    assert [each.name for each in one] == [each.name for each in other]
    scales = {
        "rate": of_y / of_time,
        "total error": of_y,
        "total": of_y,
        "early": of_y / of_time,
        "late": of_y / of_time,
        "frequency": 1.0 / of_time,
        "amplitude": of_y,
        "noise": of_y,
        "range": of_y,
        "width": of_y,
        "low": of_u,
        "high": of_u,
        "slowest": of_u / of_time,
        "fastest": of_u / of_time,
    }
    for a, b in zip(one, other, strict=True):
        for key, value in a.amounts.items():
            assert b.amounts[key] == value * scales.get(key, 1.0), (a.name, key)
