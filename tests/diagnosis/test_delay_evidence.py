"""A delay is 0 unless the records exclude it, and its interval holds the true one."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.io
import scipy.signal
import scipy.special
from delayed_records import (
    RATE,
    SETTLED,
    Array,
    bouc_wen,
    butterfly,
    dahl,
    delayed,
    drive,
    noisy,
    plays,
    preisach,
    rate_dependent,
)

import hyst
from hyst.diagnosis.delay_evidence import DelayEvidence, evidence_of_delay


def found(record: hyst.Record) -> DelayEvidence:
    return evidence_of_delay([record], [SETTLED])


def test_no_delay_is_found_where_there_is_none() -> None:
    """95 % of 36 runs are 34; every one is another plant."""
    runs = itertools.product(
        ("sine", "triangle"), (0.0, 0.75), ("pi", "mpi", "cubic"), (0.003, 0.01, 0.05)
    )
    results = [
        found(delayed(plays(seed, kind), shape, decay, noise, 0.0, seed))
        for seed, (shape, decay, kind, noise) in enumerate(runs)
    ]
    assert sum(each.low <= 0.0 <= each.high for each in results) >= 34
    assert sum(each.delay == 0.0 for each in results) >= 34


@pytest.mark.parametrize("shape", ["sine", "triangle"])
@pytest.mark.parametrize("kind", ["pi", "mpi", "cubic"])
def test_a_whole_delay_is_found(shape: str, kind: str) -> None:
    for seed in (51, 52):
        result = found(delayed(plays(seed, kind), shape, 0.75, 0.001, 4.0, seed))
        assert result.low <= 4.0 <= result.high
        assert result.excludes_zero
        assert result.delay == pytest.approx(4.0, abs=0.1)


@pytest.mark.parametrize("shape", ["sine", "triangle"])
def test_a_part_of_a_sample_is_found(shape: str) -> None:
    for seed in (61, 62, 63):
        result = found(delayed(plays(seed), shape, 0.75, 0.001, 1.4, seed))
        assert result.low <= 1.4 <= result.high
        assert result.delay == pytest.approx(1.4, abs=0.1)


@pytest.mark.parametrize("plant", [preisach, bouc_wen, dahl, butterfly])
@pytest.mark.parametrize("noise", [0.0, 0.01, 0.03])
def test_no_delay_is_invented_for_loops_that_are_no_plays(
    plant: Callable[[Array, int], Array], noise: float
) -> None:
    for seed, shape in enumerate(("sine", "triangle")):
        for decay in (0.0, 0.75):
            u = drive(shape, decay)
            result = found(noisy(u, plant(u, 70 + seed), noise, seed))
            assert result.delay == 0.0
            assert result.low <= 0.0 <= result.high


@pytest.mark.parametrize("lead", [3, 10])
@pytest.mark.parametrize("gain", [1.0, -20.0])
def test_an_output_ahead_of_its_input_is_found_and_told(lead: int, gain: float) -> None:
    record = delayed(plays(80), "sine", 0.75, 0.0005, 0.0, lead)
    ahead = hyst.Record(record.u[:-lead], gain * record.y[lead:], record.dt)
    result = found(ahead)
    assert result.delay == -lead
    assert f"ahead of the input by {lead} samples" in result.said(ahead.dt)
    (finding,) = hyst.diagnose(ahead).named("output ahead of input")
    assert finding.severity == "warning"
    assert f"--delay -{lead}" in finding.advice


@pytest.mark.parametrize("decay", [0.0, 0.75])
def test_a_force_that_follows_the_speed_is_no_negative_delay(decay: float) -> None:
    u = drive("sine", decay)
    speed = np.gradient(u) * RATE / (2.0 * np.pi)
    for share in (0.3, 1.5):
        result = found(noisy(u, dahl(u, 5) + 0.2 * u + share * speed, 0.001))
        assert result.delay == 0.0
        assert not result.excludes_zero
        assert result.low < -1.0


def test_a_measured_damper_may_follow_the_rate_or_be_misaligned(measured_data: Path) -> None:
    held = scipy.io.loadmat(measured_data / "mr-damper" / "ensaio.A.5.mat")
    damper = hyst.Record(held["dist"].ravel(), held["forc"].ravel(), 0.01)
    assert found(damper).delay == 0.0
    (finding,) = hyst.diagnose(damper).named("output ahead of input")
    assert "rate" in finding.sentence
    assert "not aligned" in finding.sentence


def test_a_few_spikes_change_nothing() -> None:
    """Eight of a third of the range, as of a bad contact."""
    clean = delayed(plays(81), "sine", 0.75, 0.001, 4.0, 81)
    y = clean.y.copy()
    places = np.random.default_rng(3).choice(y.size, 8, replace=False)
    y[places] += np.ptp(clean.y) / 3.0 * np.array([1, -1, 1, 1, -1, 1, -1, 1])
    result = found(replace(clean, y=y))
    assert result.delay == 4.0
    # A bridged sample has less noise than its neighbours, and where u turns a little misfit.
    assert result.residual_rms == pytest.approx(found(clean).residual_rms, rel=0.1)


def test_samples_that_do_not_count_are_passed_over() -> None:
    clean = delayed(plays(82), "sine", 0.75, 0.001, 4.0, 82)
    y, kept = clean.y.copy(), np.ones(len(clean), dtype=bool)
    kept[700:730] = False
    y[700:730] = y.min()
    result = evidence_of_delay([replace(clean, y=y)], [SETTLED], [kept])
    assert result.delay == 4.0
    assert result.describes


def test_records_of_other_sample_times_share_the_lag_in_seconds() -> None:
    plant = plays(83)
    records = []
    for rate, delay in ((200.0, 4), (400.0, 8)):
        u = drive("sine", 0.75, rate)
        y = np.concatenate([np.zeros(delay), plant(u)])[: u.size]
        records.append(noisy(u, y, 0.001, delay, 1.0 / rate))
    assert evidence_of_delay(records, [SETTLED, 2 * SETTLED]).delay == 4.0
    assert evidence_of_delay(records[::-1], [2 * SETTLED, SETTLED]).delay == 8.0


def test_a_loop_that_grows_with_the_rate_is_no_delay() -> None:
    records = []
    for frequency in (0.5, 2.0, 5.0):
        u = drive("sine", 0.0, 1000.0, frequency)
        records.append(noisy(u, rate_dependent(u, 1e-3), 0.003, int(frequency), 1e-3))
    starts = [int(1000 / frequency) for frequency in (0.5, 2.0, 5.0)]
    result = evidence_of_delay(records, starts)
    assert result.delay == 0.0
    assert result.low <= 0.0 <= result.high
    assert "grow with the rate" in result.said(1e-3)


@pytest.mark.parametrize(("u_power", "y_power"), [(-20, 0), (3, -40), (0, 17)])
def test_units_do_not_count(u_power: int, y_power: int) -> None:
    given = delayed(plays(84), "sine", 0.75, 0.003, 1.4, 84)
    scaled = replace(given, u=given.u * 2.0**u_power, y=given.y * 2.0**y_power)
    expected, result = found(given), found(scaled)
    assert (result.delay, result.low, result.high) == (expected.delay, expected.low, expected.high)
    assert result.residual_rms == expected.residual_rms * 2.0**y_power


def test_one_amplitude_leaves_delay_and_radius_open_and_that_is_told() -> None:
    record = delayed(plays(85), "triangle", 0.0, 0.01, 0.0, 85)
    result = found(record)
    assert result.delay == 0.0
    assert "cannot be told apart" in result.said(record.dt)
    (finding,) = hyst.diagnose(record).named("delay or radius")
    assert finding.severity == "remark"
    decaying = delayed(plays(85), "triangle", 0.75, 0.01, 0.0, 85)
    assert not hyst.diagnose(decaying).named("delay or radius")


def test_sentences_tell_delay_interval_and_seconds() -> None:
    lag = DelayEvidence(4.0, 3.8, 4.2, 25.0, 0.1, 0.1, True, True, False)
    assert lag.said(0.005) == "the output lags by 4 samples (3.8 to 4.2), 0.02 s"
    none = replace(lag, delay=0.0, low=-0.3, high=2.0, excludes_zero=False)
    assert none.said(0.005) == "no delay is needed: -0.3 to 2 samples are as good"


def test_a_record_that_is_too_short_tells_nothing() -> None:
    u = np.array([0.0, 1.0, 0.0, 1.0, 0.0, 1.0])
    result = evidence_of_delay([hyst.Record(u, u, 1.0)], [0])
    assert (result.delay, result.limit) == (0.0, 0.0)
    assert "too short" in result.said(1.0)


@pytest.mark.parametrize("width", [3.0, 6.0])
@pytest.mark.parametrize("unit", [1.0, 2.0**-9])
def test_a_delay_that_misfit_bought_does_not_exclude_none(width: float, unit: float) -> None:
    """A play that saturates, of one amplitude: its flat ends pass for a delay; there is none."""
    t = np.arange(4000)
    u = 50.0 * np.sin(2.0 * np.pi * t / 500.0)
    noise = 0.05 * np.random.default_rng(1).standard_normal(t.size)
    y = 30.0 * np.tanh(hyst.Play(8.0)(u) / width) + noise
    record = hyst.Record(u, unit * y, dt=0.001)
    result = evidence_of_delay([record], [500])
    assert not result.describes
    low, high = result.stated
    assert low <= 0.0 <= high
    told = [each.sentence for each in hyst.diagnose(record).named("delay or radius")]
    assert len(told) == 1
    assert "nothing certain can be said of a delay" in told[0]


@pytest.mark.parametrize(("coercive", "width"), [(0.35, 0.23), (0.3, 0.28), (0.2, 0.2)])
@pytest.mark.parametrize("seed", [0, 1])
def test_a_saturated_major_loop_is_neither_early_nor_late(
    coercive: float, width: float, seed: int
) -> None:
    """Its output rests where the input turns, so that a delay would only stand in for its shape."""
    u = scipy.signal.sawtooth(2.0 * np.pi * np.arange(800) / 400.0, 0.5)
    way = np.sign(np.diff(u, append=u[-1] - 1.0))
    y = scipy.special.ndtr((u - way * coercive) / width)
    y = y + 0.002 * np.random.default_rng(seed).normal(size=y.size)
    found = evidence_of_delay([hyst.Record(u, y, 0.01)], [0])
    assert found.delay == 0.0
    assert found.low <= 0.0 <= found.high


def test_a_lead_of_one_amplitude_is_still_told() -> None:
    """The output of plays, written down 6 samples early: it goes back before its input turns."""
    u = np.sin(2.0 * np.pi * np.arange(1200) / 200.0)
    y = hyst.PrandtlIshlinskii([0.5, 0.3], [0.1, 0.3], p0=1.0)(u)
    y = np.roll(y, -6) + 1e-3 * np.random.default_rng(2).normal(size=y.size)
    found = evidence_of_delay([hyst.Record(u[400:1100], y[400:1100], 0.01)], [0])
    assert found.low - 0.5 <= -6.0 <= found.high + 0.5
    assert found.delay < -2.0
