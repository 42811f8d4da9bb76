"""Every cause is named with the size it was simulated with, where it was left in the record."""

from __future__ import annotations

import re

import numpy as np
import pytest

import hyst
from hyst.operators import Verdict
from reference.foreign_records import (
    DT,
    FOREIGN,
    at_rates,
    bouc_wen,
    drive,
    late,
    plays,
    record,
    ringing,
)
from reference.judged_as_given import judged_as_given

NOISE = 0.002


def verdict_on(records: hyst.Record | list[hyst.Record], **options: object) -> Verdict:
    """Give the verdict on plays, drift and sines left in."""
    asked = {"family": "pi", "plays": 3, "delay": 0, "allow_unconverged": True, "drift": False}
    return hyst.identify(records, **(asked | options)).verdict


def told(verdict: Verdict, words: str) -> str:
    """Give the sentence with these words; the test fails where there is none."""
    found = [each for each in verdict.sentences if words in each]
    assert found, verdict.sentences
    return found[0]


def numbers(sentence: str) -> list[float]:
    return [float(each) for each in re.findall(r"-?\d+\.?\d*(?:e[-+]?\d+)?", sentence)]


@pytest.mark.parametrize("kind", ["sine", "triangle", "decaying sine", "multisine"])
@pytest.mark.parametrize("rate", [1.5, -0.7])
def test_drift_is_told_by_the_second_and_in_all(kind: str, rate: float) -> None:
    u = drive(kind, 40.0, seed=2)
    y = plays(40.0, 2)(u) + rate * np.arange(u.size) * DT
    verdict = verdict_on(record(u, y, NOISE))
    # Noise of 0.1 um over 4 s knows a slope to 0.2 % (0.4 % of the smaller); loops take some of it,
    # and more where the amplitude falls as steadily as the output drifts.
    stated = numbers(told(verdict, "drifts by"))[0]
    assert stated == pytest.approx(rate, rel=0.2 if kind == "decaying sine" else 0.05)
    assert verdict.level == "fair"


@pytest.mark.parametrize("frequency", [50.0, 60.0, 47.3, 123.4])
@pytest.mark.parametrize("amplitude", [0.3, 0.8])
def test_a_sine_is_told_with_frequency_and_amplitude(frequency: float, amplitude: float) -> None:
    u = drive("triangle", 40.0, seed=1)
    hum = amplitude * np.sin(2.0 * np.pi * frequency * np.arange(u.size) * DT + amplitude)
    verdict = verdict_on(record(u, plays(40.0, 1)(u) + hum, NOISE))
    sentence = told(verdict, "there is a sine of")
    stated = numbers(sentence)
    # The bound of Cramer and Rao is 1 mHz and 2 um / 1000 here; printed to five digits.
    assert stated[0] == pytest.approx(frequency, abs=0.01)
    assert numbers(sentence.split("amplitude")[1])[0] == pytest.approx(amplitude, rel=0.03)
    assert ("mains" in sentence) == (frequency in (50.0, 60.0))
    assert verdict.level == "fair"


@pytest.mark.parametrize("amplitude", [0.3, 0.8])
@pytest.mark.parametrize("frequency", [123.4, 47.3])
def test_a_sine_that_was_taken_out_is_told_as_that(frequency: float, amplitude: float) -> None:
    u = drive("triangle", 40.0, seed=2)
    hum = amplitude * np.sin(2.0 * np.pi * frequency * np.arange(u.size) * DT + 1.0)
    verdict = verdict_on(record(u, plays(40.0, 2)(u) + hum, NOISE), drift="auto")
    sentence = told(verdict, "it was taken out before the fit")
    stated = numbers(sentence)
    # Before any model what branches have in common with the sine hides a few per cent of it.
    assert stated[0] == pytest.approx(frequency, abs=0.05)
    assert stated[1] == pytest.approx(amplitude, rel=0.1)
    assert verdict.level == "fair"
    told(verdict, "is the record's own noise")


@pytest.mark.parametrize("amplitude", [0.3, 0.8])
def test_a_sine_locked_to_the_drive_is_named_before_or_after_the_fit(amplitude: float) -> None:
    """As the 25th harmonic of the drive it resembles what repeats with it."""
    u = drive("triangle", 40.0, seed=2)
    hum = amplitude * np.sin(2.0 * np.pi * 50.0 * np.arange(u.size) * DT + 1.0)
    verdict = verdict_on(record(u, plays(40.0, 2)(u) + hum, NOISE), drift="auto")
    told(verdict, "a sine of 50")
    assert verdict.level == "fair"


@pytest.mark.parametrize("rate", [1.5, -0.7])
def test_drift_that_was_taken_out_is_told_as_that(rate: float) -> None:
    u = drive("sine", 40.0, seed=3)
    y = plays(40.0, 3)(u) + rate * np.arange(u.size) * DT
    verdict = verdict_on(record(u, y, NOISE), drift="auto")
    sentence = told(verdict, "it was taken out before the fit")
    assert numbers(sentence)[0] == pytest.approx(rate, rel=0.02)
    assert verdict.level == "fair"
    told(verdict, "is the record's own noise")


@pytest.mark.parametrize("samples", [0.45, -0.45])
def test_a_lag_of_part_of_a_sample_is_told(samples: float) -> None:
    """A multisine to 60 Hz: the output changes by 4 % of its range in a sample."""
    t = np.arange(4000) * DT
    phases = np.random.default_rng(5).uniform(0.0, 2.0 * np.pi, 30)
    u = np.sin(2.0 * np.pi * np.outer(t, np.arange(2, 62, 2)) + phases).sum(axis=1)
    y = late(plays(float(np.abs(u).max()), 4)(u), samples)
    sentence = told(verdict_on(record(u, y, 1e-3)), "by another")
    assert ("lags behind" in sentence) == (samples > 0.0)
    # Halving between samples smooths the output, which plays of other radii take for some of it.
    assert numbers(sentence)[0] == pytest.approx(abs(samples), abs=0.1)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_outliers_are_counted(seed: int) -> None:
    records = FOREIGN["outliers"](drive("sine", seed=seed), seed, NOISE)
    verdict = judged_as_given(records, hyst.families.PrandtlIshlinskii(plays=3))
    assert told(verdict, "far from the others").startswith("8 samples")
    assert verdict.level == "fair"


@pytest.mark.parametrize("seed", [0, 1])
def test_a_loop_that_depends_on_the_rate_is_told_with_errors_by_rate(seed: int) -> None:
    verdict = verdict_on(at_rates((1.0, 10.0, 40.0), 0.25, seed, NOISE))
    sentence = told(verdict, "depends on the rate at which it is run")
    assert "rms at 1 Hz and by" in sentence
    assert "rms at 40 Hz." in sentence


def test_an_error_that_grows_with_the_rate_is_told() -> None:
    """White noise that grows with the rate has no other name."""
    records = []
    for number, frequency in enumerate((2.0, 5.0, 10.0)):
        u = np.sin(2.0 * np.pi * frequency * np.arange(2000) * DT)
        records.append(record(u, plays(seed=1)(u), NOISE * (1.0 + number)))
    sentence = told(verdict_on(records), "grows with the rate")
    assert sentence.endswith("at 10 Hz: the loop depends on it.")


@pytest.mark.parametrize("seed", [0, 1])
def test_records_of_several_actuators_are_told(seed: int) -> None:
    verdict = verdict_on(FOREIGN["records"](drive("decaying sine", seed=seed), seed, NOISE))
    sentence = told(verdict, "do not agree with one model")
    assert numbers(sentence)[0] > 2.0 * NOISE, sentence
    assert verdict.level != "good"


def test_one_record_of_another_actuator_is_named() -> None:
    u = drive("decaying sine", seed=3)
    y = plays(seed=3)(u)
    records = [record(u, (1.15 if i == 4 else 1.0) * y, NOISE, i) for i in range(8)]
    assert "record 5 is of another actuator" in told(verdict_on(records), "do not agree")


def test_zeros_of_records_are_told() -> None:
    u = drive("decaying sine", seed=3)
    y = plays(seed=3)(u)
    records = [record(u, y + 0.1 * i, NOISE, i) for i in range(3)]
    verdict = verdict_on(records)
    # 0, 0.1 and 0.2 about their mean: rms 0.0816.
    assert numbers(told(verdict, "different zeros"))[0] == pytest.approx(0.0816, rel=0.05)
    assert verdict.level == "fair"


@pytest.mark.parametrize("kind", ["sine", "triangle"])
def test_a_change_on_the_way_makes_it_unfit(kind: str) -> None:
    verdict = verdict_on(FOREIGN["change"](drive(kind, seed=1), 1, NOISE))
    assert "two actuators, one after the other" in verdict.sentences[0]
    assert verdict.level == "unfit"


@pytest.mark.parametrize("kind", ["sine", "triangle"])
def test_creep_after_the_start_is_told(kind: str) -> None:
    verdict = verdict_on(FOREIGN["creep"](drive(kind, seed=2), 2, NOISE))
    told(verdict, "creeps")
    assert verdict.level == "fair"


def test_slow_wandering_is_told() -> None:
    """Three periods of a slow sine over twenty cycles of the drive."""
    t = np.arange(10_000) * DT
    u = np.sin(2.0 * np.pi * 2.0 * t)
    y = plays(seed=1)(u)
    slow = 0.02 * np.ptp(y) * np.sin(2.0 * np.pi * 0.3 * t + 0.4)
    sentence = told(verdict_on(record(u, y + slow, NOISE)), "wanders slowly")
    # Its rms is 0.02 / sqrt(2) of the range; twelve straight pieces leave a few per cent of it.
    assert numbers(sentence)[0] == pytest.approx(0.0141 * np.ptp(y), rel=0.1)


def test_dynamics_are_told_where_the_drive_is_fast_enough() -> None:
    t = np.arange(4000) * DT
    phases = np.random.default_rng(5).uniform(0.0, 2.0 * np.pi, 20)
    u = np.sin(2.0 * np.pi * np.outer(t, np.arange(2, 42, 2)) + phases).sum(axis=1)
    y = ringing(plays(float(np.abs(u).max()), 4)(u), 150.0, 0.3)
    verdict = verdict_on(record(u, y, NOISE))
    assert any("dynamics" in each or "lags behind" in each for each in verdict.sentences)
    assert verdict.level != "good"


@pytest.mark.parametrize("kind", ["decaying sine", "multisine"])
def test_loops_of_another_shape_are_told(kind: str) -> None:
    u = drive(kind, seed=1)
    verdict = verdict_on(record(u, bouc_wen(u), NOISE))
    told(verdict, "another shape")
    assert verdict.level != "good"


def test_a_zero_that_may_not_move_is_told() -> None:
    u = drive("decaying sine", seed=2)
    true = plays(seed=2)
    found = hyst.fit(true, record(u, true(u) + 0.3, NOISE))
    assert numbers(told(found.verdict, "zero is off"))[0] == pytest.approx(0.3, rel=0.05)


def test_a_drive_of_one_rate_names_no_rate_and_no_dynamics() -> None:
    """Rate and shape of one loop are not told apart by it."""
    u = drive("sine", seed=2)
    verdict = verdict_on(record(u, switched := bouc_wen(u) ** 3, NOISE))
    assert np.ptp(switched) > 0.0
    assert not any("on the rate" in each or "answers with" in each for each in verdict.sentences)


@pytest.mark.parametrize(("hertz", "gain"), [(60.0, 1.0), (25.0, -3.0)])
def test_a_sweep_through_a_resonance_is_told_to_need_dynamics(hertz: float, gain: float) -> None:
    """A line or plays leave what no cause explains there; the diagnosis has seen it before."""
    w = 2.0 * np.pi * hertz
    G = hyst.LinearDynamics.from_continuous([w**2], [1.0, 0.06 * w, w**2], 1e-3, delay=2)
    front = hyst.PrandtlIshlinskii([0.2, 0.2], [1.0, 4.0], 0.6)
    u = hyst.signals.swept_sine(1e-3, 8000, amplitude=10.0, band=(1.0, 4.0 * hertz), max_rate=2e3).u
    y = gain * (G @ front)(u)
    y = y + 0.01 * y.std() * np.random.default_rng(int(hertz)).normal(size=y.size)
    swept = hyst.Record(u, y, dt=1e-3)
    for family in ("linear", "pi"):
        found = hyst.identify(swept, family=family, delay=0, allow_unconverged=True)
        assert found.verdict.level == "unfit"
        assert sum("--family hammerstein" in each for each in found.verdict.sentences) == 1
    own = hyst.identify(swept, family="hammerstein", hysteresis="pi", plays=2).verdict
    assert own.level == "good"
    assert not any("--family hammerstein" in each for each in own.sentences)


def test_a_loop_that_dynamics_turn_clockwise_is_no_exchange_of_columns() -> None:
    """Above its resonance an output is turned round, so that its loop is run clockwise."""
    w = 2.0 * np.pi * 20.0
    G = hyst.LinearDynamics.from_continuous([w**2], [1.0, 0.1 * w, w**2], 1e-3)
    u = hyst.signals.multisine(1e-3, 6000, amplitude=10.0, band=(2.0, 60.0)).u
    y = (G @ hyst.PrandtlIshlinskii([0.3], [2.0], 1.0))(u)
    y = y + 0.01 * y.std() * np.random.default_rng(0).normal(size=y.size)
    driven = hyst.Record(u, y, dt=1e-3)
    found = hyst.identify(driven, family="hammerstein", hysteresis="pi", plays=1)
    assert any(each.name == "run direction" for each in found.diagnosis.findings)
    assert found.verdict.level == "good"
    assert not any("clockwise" in each for each in found.verdict.sentences)
