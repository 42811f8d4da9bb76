"""Switching materials whose thresholds move with the rate."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from reference.switching_material import gaussian, reversal_turns, strokes, switched

DENSITY = gaussian(0.35, 0.12, 0.15)
SHIFT, EXPONENT = 0.08, 0.3
MAJOR = [-1.0, 1.0, -1.0, 1.0]


def record(turns: list[float], samples: int, dt: float, seed: int) -> hyst.Record:
    """Straight strokes: relays see the input less a shift, while it goes one way and so fast."""
    u = strokes(turns, samples)
    width = SHIFT * (1.0 / samples / dt) ** EXPONENT
    seen = np.empty(u.size)
    last = 0.0
    for k, each in enumerate(u):
        # The first sample is at rest, where nothing is shifted.
        reach = width if k else 0.0
        last = min(max(last, each - reach), each + reach)
        seen[k] = last
    y = switched(DENSITY, seen)
    return hyst.Record(u, y + 0.002 * np.random.default_rng(seed).normal(size=u.size), dt)


def rates(seed: int) -> list[hyst.Record]:
    turns = [*MAJOR, *reversal_turns([-0.5, 0.0, 0.4]), -1.0]
    return [record(turns, samples, 0.01, seed + samples) for samples in (200, 50, 13)]


def test_shift_and_exponent_are_found() -> None:
    found = hyst.identify(rates(1), family="rate-dependent-preisach", delay=0)
    told = dict(zip(found.parameter_names, found.parameter_values, strict=True))
    # c x^m at the rates of the records, 0.5 to 7.7 a second: what is common to all of them is told
    # by minor loops only, so it is the difference that is known.
    x = 1.0 / (np.array([200, 50, 13]) * 0.01)
    shifts = told["rate_shift.c"] * x ** told["rate_shift.m"]
    true = SHIFT * x**EXPONENT
    # A cell is 0.08 wide; noise knows a shift to a hundredth of that.
    np.testing.assert_allclose(np.diff(shifts), np.diff(true), atol=0.004)
    assert found.metrics["training"].rms_percent < 0.35


def test_another_rate_is_foretold() -> None:
    found = hyst.identify(rates(2), family="rate-dependent-preisach", delay=0)
    other = record([*MAJOR, *reversal_turns([-0.3, 0.2]), -1.0], 100, 0.01, seed=7)
    top = int(other.u.argmax())
    left = (found.model.at_sample_time(other.dt)(other.u) - other.y)[top:]
    # Noise of 0.2 % and as much of the model's.
    assert np.sqrt(np.mean(np.square(left))) < 0.004


def test_a_material_without_rate_gets_no_shift() -> None:
    drives = [strokes([*MAJOR, -0.4, 0.6, -1.0], samples) for samples in (150, 30)]
    records = [
        hyst.Record(
            u, switched(DENSITY, u) + 0.002 * np.random.default_rng(i).normal(size=u.size), 0.01
        )
        for i, u in enumerate(drives)
    ]
    found = hyst.identify(records, family="rate-dependent-preisach", delay=0)
    told = dict(zip(found.parameter_names, found.parameter_values, strict=True))
    x = 1.0 / (np.array([150, 30]) * 0.01)
    shifts = told["rate_shift.c"] * x ** told["rate_shift.m"]
    # As above.
    assert abs(np.diff(shifts)[0]) < 0.004


def test_records_of_a_material_whose_loops_widen_with_the_rate(cases) -> None:  # type: ignore[no-untyped-def]
    records = []
    for name in ("f1Hz", "f0.2Hz", "f0.05Hz"):
        t, u, y = np.loadtxt(
            cases / "switching-with-rate" / f"{name}.csv", delimiter=",", skiprows=1
        ).T
        records.append(hyst.Record(u, y, float(t[1] - t[0])))
    found = hyst.identify(records, family="rate-dependent-preisach")
    assert found.delay == 0
    # What the case asks for; plays leave 10 %.
    assert all(each.metrics.rms_percent < 1.0 for each in found.per_record)
    # Three widths of one loop: shift, exponent and coercive field trade off, and none has an error.
    errors = dict(zip(found.parameter_names, found.standard_errors, strict=True))
    assert np.isnan([errors[f"rate_shift.{each}"] for each in "cm"]).all()
    assert any("trade off" in each for each in found.undetermined)
    with pytest.raises(hyst.NotInvertibleError, match="follow the rate"):
        found.model.inverse()
