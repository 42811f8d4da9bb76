"""Loops whose slope grows or falls to a limit: found, told honestly, or refused."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import hyst
from hyst import InputError, MasingOperator, NotIdentifiableError, Record
from hyst.models import ExponentialCurve
from reference.family_examples import decaying, family_example

Array = NDArray[np.float64]


def noisy(model: hyst.Operator, u: Array, share: float, seed: int = 0) -> Record:
    y = model(u)
    rng = np.random.default_rng(seed)
    return Record(u, y + share * np.ptp(y) * rng.normal(size=u.size), 1e-3)


def other_drive(samples: int = 1500) -> Array:
    t = np.arange(samples) / samples
    return 0.5 * np.sin(2 * np.pi * 3.3 * t) + 0.45 * np.sin(2 * np.pi * 7.9 * t + 1.0)


def sine(amplitude: float, samples: int = 2000) -> Array:
    return amplitude * np.sin(2 * np.pi * 10.0 * np.arange(samples) / samples)


@pytest.mark.parametrize("way", [60.0, 100.0, 150.0, 200.0])
def test_slopes_that_grow_to_a_limit_are_no_longer_refused(way: float) -> None:
    """Slope 3 after a turn, 8 far out, over a way of ``way``; 6 of some 3500 noise."""
    actuator = MasingOperator(ExponentialCurve(8.0, 5.0, way / 2.0))
    u = sine(250.0)
    y = actuator(u) + 6.0 * np.random.default_rng(1).normal(size=u.size)
    record = Record(u, y, 5e-4)
    power = hyst.identify(record, family="ramberg-osgood", delay=0)
    line = float(np.std(y - np.polyval(np.polyfit(u, y, 1), u)))
    # A power law leaves a fifth of what a line leaves, and does not call it good.
    assert power.metrics["training"].rms < 0.2 * line
    assert power.verdict.level == "fair"
    found = hyst.identify(record, family="masing", delay=0)
    assert found.verdict.level == "good"
    told = dict(zip(found.parameter_names, found.parameter_values, strict=True))
    errors = dict(zip(found.parameter_names, found.standard_errors, strict=True))
    for name, truth in (("masing.c", 8.0), ("masing.d", 5.0), ("masing.b", way / 2.0)):
        # Four standard errors: one in ten thousand.
        assert abs(told[name] - truth) < 4.0 * errors[name]
    # And on another drive: four constants from 2000 samples of noise 6.
    shrinking = u * np.linspace(1.0, 0.3, u.size)
    assert np.std(found.model(shrinking) - actuator(shrinking)) < 1.0


def test_a_power_law_that_starts_flat_is_found_and_told() -> None:
    actuator = hyst.RambergOsgood(0.0, 2.0, 0.4)
    found = hyst.identify(noisy(actuator, decaying(), 0.002), family="ramberg-osgood", delay=0)
    told = dict(zip(found.parameter_names, found.parameter_values, strict=True))
    assert told["ramberg_osgood.c1"] == 0.0
    assert told["ramberg_osgood.c2"] == pytest.approx(2.0, rel=0.02)
    assert told["ramberg_osgood.c3"] == pytest.approx(0.4, rel=0.05)
    assert any("c1 came out at 0" in each for each in found.undetermined)
    assert found.model.is_invertible()


def test_a_softening_loop_is_still_no_power_law() -> None:
    record = noisy(MasingOperator(ExponentialCurve(0.5, -1.0, 0.4)), decaying(), 0.002)
    with pytest.raises(NotIdentifiableError, match=r"does not grow .* use family 'masing'"):
        hyst.identify(record, family="ramberg-osgood", delay=0)


SHAPES = {
    "stiffens": ({}, ExponentialCurve(1.5, 1.2, 0.3)),
    "softens": ({}, ExponentialCurve(0.4, -1.0, 0.25)),
    "saturates": ({"curve": "saturating"}, ExponentialCurve(0.0, -1.0, 0.3)),
}


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_both_signs_and_saturation_come_back(name: str, sign: float) -> None:
    options, curve = SHAPES[name]
    actuator = hyst.Affine(sign, -0.7) @ MasingOperator(curve)
    found = hyst.identify(noisy(actuator, decaying(), 0.0), family="masing", delay=0, **options)
    truth = dict(
        zip(actuator.parameters().names, actuator.parameters().values.tolist(), strict=True)
    )
    for key, value in zip(found.parameter_names, found.parameter_values, strict=True):
        assert value == pytest.approx(truth[key], rel=1e-6)
    assert found.verdict.level == "good"


def test_records_of_several_amplitudes_are_fitted_together() -> None:
    actuator = MasingOperator(ExponentialCurve(1.5, 1.2, 0.3))
    records = [noisy(actuator, a * sine(1.0, 600), 0.003, seed) for seed, a in enumerate((1, 0.4))]
    found = hyst.identify(records, family="masing", delay=0)
    errors = (found.parameter_values[:3] - [1.5, 1.2, 0.3]) / found.standard_errors[:3]
    assert np.abs(errors).max() < 4.0  # one in ten thousand each


def test_a_way_longer_than_the_record_is_an_extrapolation_or_no_estimate() -> None:
    long = MasingOperator(ExponentialCurve(1.5, 1.2, 1.6))
    found = hyst.identify(noisy(long, decaying(), 0.0005), family="masing", delay=0)
    assert any("c is an extrapolation" in each for each in found.undetermined)
    endless = MasingOperator(ExponentialCurve(100.0, 99.5, 100.0))
    found = hyst.identify(noisy(endless, decaying(), 0.0005), family="masing", delay=0)
    assert any("b came out at its upper limit" in each for each in found.undetermined)


@pytest.mark.parametrize("family", ["masing", "iwan"])
@pytest.mark.parametrize("seed", range(3))
def test_a_line_is_refused(family: str, seed: int) -> None:
    record = noisy(hyst.Affine(2.0, 1.0), decaying(), 0.01, seed)
    # Which of the two depends on which way the noise happens to bend it.
    with pytest.raises(NotIdentifiableError, match=r"than a straight line|does not soften"):
        hyst.identify(record, family=family, delay=0)


def test_a_stiffening_loop_does_not_slide() -> None:
    record = noisy(MasingOperator(ExponentialCurve(1.5, 1.2, 0.3)), decaying(), 0.002)
    with pytest.raises(NotIdentifiableError, match="does not soften after a turn"):
        hyst.identify(record, family="iwan", delay=0)


def test_without_macro_slip_iwan_is_refused() -> None:
    joint = hyst.Iwan(3.0, 3.0, -0.2, 0.5, 0.3)  # phi_max 1.6, the record reaches 1
    with pytest.raises(NotIdentifiableError, match="do not reach macro-slip"):
        hyst.identify(noisy(joint, decaying(), 0.002), family="iwan", delay=0)


def test_iwan_with_what_is_known_kept() -> None:
    uniform = hyst.Iwan(1.0, 4.0, 0.0, 0.0)
    found = hyst.identify(
        noisy(uniform, decaying(), 0.0), family="iwan", delay=0, chi=0, beta=0, spring="none"
    )
    assert found.parameter_names == ("iwan.F_S", "iwan.K_T", "affine.offset")
    assert found.parameter_values == pytest.approx([1.0, 4.0, 0.0], rel=1e-6, abs=1e-9)
    assert not found.model.is_invertible()
    with pytest.raises(InputError, match=r"chi is -0\.95; give -0\.9 to 5, or 'free'"):
        hyst.families.Iwan(chi=-0.95)
    with pytest.raises(InputError, match="beta is -1; give 0 to 20, or 'free'"):
        hyst.families.Iwan(beta=-1)


def test_iwan_predicts_another_drive() -> None:
    example = family_example("iwan")
    found = hyst.identify(example.records(0.005), family="iwan", delay=0)
    u = other_drive()
    truth = example.model(u)
    # Six constants of 1500 samples of 0.5 % noise: 0.03 %.
    assert np.sqrt(np.mean((found.model(u) - truth) ** 2)) < 1e-3 * np.ptp(truth)
    # A piecewise linear sum of a few plays has kinks where this curve has none.
    plays = hyst.identify(example.records(0.005), family="pi", delay=0, plays=2)
    assert np.std(plays.model(u) - truth) > 3.0 * np.std(found.model(u) - truth)
