"""Creep between hysteresis and dynamics: its time constants are not taken for poles, nor poles."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hyst
from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.families.hammerstein import IdentifiedHammerstein
from hyst.models import LinearDynamics
from hyst.signals import Record

DT = 1e-3
W = 2.0 * np.pi * 200.0
RESONANCE = LinearDynamics.from_continuous([W * W], [1.0, 0.06 * W, W * W], DT, 1)
AMPLIFIER = LinearDynamics.from_continuous([1.0], [0.003, 1.0], DT)
PI = hyst.PrandtlIshlinskii([0.12, 0.09, 0.08, 0.06, 0.05], [0.5, 1.5, 3.0, 5.0, 8.0], 0.6)
RADII = [0.5, 1.5, 3.0, 5.0, 8.0]
WEIGHTS, TIMES = (0.08, 0.12), (0.1, 2.0)
CREEP = hyst.Creep(WEIGHTS, TIMES, DT)
LEVELS = np.random.default_rng(3).uniform(-10.0, 10.0, 48).repeat(250)
OTHER = np.random.default_rng(7).uniform(-9.0, 9.0, 24).repeat(500)


def record_of(plant: hyst.Operator, noise: float = 0.005, seed: int = 0, first: int = 0) -> Record:
    y = plant(LEVELS)
    y = y + noise * y.std() * np.random.default_rng(seed).normal(size=y.size)
    return Record(LEVELS[first:], y[first:], DT)


def identified(record: Record, **options: Any) -> IdentifiedHammerstein:
    found = hyst.identify(record, family="hammerstein", **{"hysteresis": "pi"} | options)
    assert isinstance(found, IdentifiedHammerstein)
    return found


def off_in_standard_errors(found: IdentifiedHammerstein) -> tuple[float, float]:
    """Give the largest error of the lags over its standard error, and that over the truth."""
    values = dict(zip(found.parameter_names, found.parameter_values, strict=True))
    errors = dict(zip(found.parameter_names, found.standard_errors, strict=True))
    off, unsure = [], []
    for name, truth in (("weights", WEIGHTS), ("time_constants", TIMES)):
        for i, true in enumerate(truth, 1):
            key = f"creep.{name}[{i}]"
            off.append(abs(values[key] - true) / errors[key])
            unsure.append(errors[key] / true)
    return max(off), max(unsure)


@pytest.mark.parametrize("more", [{}, {"dynamics": RESONANCE}], ids=["free", "dynamics known"])
def test_creep_and_a_resonance_come_back(more: dict[str, Any]) -> None:
    plant = RESONANCE @ CREEP @ PI
    found = identified(record_of(plant), creep=2, radii=RADII, **more)
    off, unsure = off_in_standard_errors(found)
    assert off < 4.0  # one run in some thousands fails
    assert unsure < 0.125  # or the errors would say nothing
    assert found.dynamics.order == 2
    assert np.sort_complex(found.poles) == pytest.approx(
        np.sort_complex(RESONANCE.poles()), abs=1e-3
    )
    error = (found.model(OTHER) - plant(OTHER))[500:].std() / plant(OTHER).std()
    assert error < 2e-3  # 0.5 % noise over 12,000 samples and a dozen constants: 0.02 %
    assert found.verdict.level == "good"
    assert any("stands between hysteresis and dynamics" in each for each in found.undetermined)


def test_without_creep_the_same_record_is_far_off() -> None:
    plant = RESONANCE @ CREEP @ PI
    found = identified(record_of(plant), creep=None, radii=RADII, state_order=2)
    assert (found.model(OTHER) - plant(OTHER))[500:].std() > 0.02 * plant(OTHER).std()


def test_a_lag_of_the_amplifier_stays_with_the_dynamics() -> None:
    plant = RESONANCE @ AMPLIFIER @ CREEP @ PI
    found = identified(record_of(plant), creep=2, radii=RADII, state_order=3)
    off, unsure = off_in_standard_errors(found)
    assert off < 4.0  # one run in some thousands fails
    assert unsure < 0.125  # or the errors would say nothing
    real = found.poles[np.abs(found.poles.imag) < 1e-9].real
    assert -DT / np.log(real.max()) == pytest.approx(0.003, rel=0.02)


def test_what_lags_did_before_the_record_is_none_of_the_hysteresis() -> None:
    """The record begins in the middle: the lags are not at rest then, and nobody knows where."""
    plant = RESONANCE @ CREEP @ PI
    found = identified(record_of(plant, first=3000), creep=2, radii=RADII, dynamics=RESONANCE)
    off, unsure = off_in_standard_errors(found)
    assert off < 4.0  # one run in some thousands fails
    assert unsure < 0.125  # or the errors would say nothing


def test_known_hysteresis_creeps_too() -> None:
    plant = RESONANCE @ CREEP @ PI
    record = record_of(plant)
    found = hyst.identify(record, family="hammerstein", front=PI, dynamics=RESONANCE, creep=2)
    assert isinstance(found, IdentifiedHammerstein)
    off, unsure = off_in_standard_errors(found)
    assert off < 4.0  # one run in some thousands fails
    assert unsure < 0.125  # or the errors would say nothing


def test_creep_that_is_not_there_has_no_weight() -> None:
    found = identified(record_of(RESONANCE @ PI), creep=1, radii=RADII, dynamics=RESONANCE)
    values = dict(zip(found.parameter_names, found.parameter_values, strict=True))
    assert values["creep.weights[1]"] < 2e-3  # of the output, at 0.5 % noise


def test_auto_looks_for_none_and_units_do_not_matter() -> None:
    record = record_of(RESONANCE @ CREEP @ PI)
    options: dict[str, Any] = {"radii": RADII, "dynamics": RESONANCE}
    assert not any("creep" in each for each in identified(record, **options).parameter_names)
    one = identified(record, creep=2, **options)
    scaled = Record(0.5 * record.u, 8.0 * record.y, DT)
    other = identified(scaled, creep=2, **options | {"radii": [0.5 * each for each in RADII]})
    assert np.array_equal(8.0 * one.model(record.u), other.model(scaled.u))


def test_what_cannot_creep_is_refused() -> None:
    u = LEVELS[:1500]
    record = Record(u, RESONANCE(u), DT)
    family = "linear,hammerstein"
    with pytest.raises(NotIdentifiableError, match=r"hammerstein, whose dynamics .* name it alone"):
        hyst.identify(record, family=family, hysteresis="linear", state_order=2, creep=2)
    with pytest.raises(InputError, match="creep is 6"):
        identified(record, creep=6)
