"""Noise of a measured drive is no rate: it is smoothed out, and counted in the standard errors."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import hyst
from hyst.identification.record_use.smoothed_drive import without_noise
from reference.rate_laws import BETA, LAWS, NOISE, estimates, plant, records, sine, triangle

Array = np.ndarray

DRIVE_NOISE = 0.05
"""0.06 % of the drive's range."""


def record_of(u: Array, dt: float) -> hyst.Record:
    return hyst.Record(u, u + 1.0, dt=dt)


def noisy(u: Array, seed: int) -> Array:
    return u + DRIVE_NOISE * np.random.default_rng(seed).normal(size=u.size)


@pytest.mark.parametrize("shape", [sine, triangle])
@pytest.mark.parametrize(("frequency", "periods"), [(1.0, 1.7), (50.0, 10.0), (100.0, 10.0)])
def test_what_is_left_of_the_noise(
    shape: Callable[..., Array], frequency: float, periods: float
) -> None:
    u = shape(frequency, periods, 1e-4)
    smoother = without_noise(record_of(noisy(u, 1), 1e-4))
    assert smoother is not None
    # 1000 to 17 000 samples tell a standard deviation to 1 to 2 %.
    assert smoother.noise == pytest.approx(DRIVE_NOISE, rel=0.07)
    left = smoother(noisy(u, 1)) - u
    assert np.std(left) < 0.45 * DRIVE_NOISE
    # Noise alone makes a rate of sqrt(2) 0.05 / dt = 707 per second.
    assert np.std(np.diff(left)) / 1e-4 < 0.15 * np.sqrt(2.0) * DRIVE_NOISE / 1e-4
    # Rounded off, the corner of the fastest triangle would be 0.8 off or more.
    assert np.abs(left).max() < 5.0 * DRIVE_NOISE


@pytest.mark.parametrize(
    "u",
    [
        sine(1.0, 2.0, 1e-3),
        sine(100.0, 20.0, 5e-4),  # 20 samples a loop
        triangle(10.0, 5.0, 1e-4),
        np.repeat(np.round(sine(1.0, 2.0, 0.05), 1), 10),  # stairs
        np.cumsum(np.sin(np.arange(2000.0) ** 1.5 / 2e3)),
    ],
)
def test_a_clean_drive_is_left_as_it_is(u: Array) -> None:
    assert without_noise(record_of(u, 1e-3)) is None


def test_a_clean_drive_gives_the_same_bits_as_no_filter() -> None:
    taken = records(LAWS["linear"], seed=1)
    one = hyst.identify(taken, family="rdpi", plays=3, delay=0)
    other = hyst.identify(taken, family="rdpi", plays=3, delay=0, rate_filter="none")
    assert np.array_equal(one.parameter_values, other.parameter_values)
    assert np.array_equal(one.standard_errors, other.standard_errors, equal_nan=True)


@pytest.mark.parametrize("shape", [sine, triangle])
def test_beta_is_right_beside_drive_noise(shape: Callable[..., Array]) -> None:
    """Without a filter r[1] is off by 2.5 and p[2] by 3.4 standard errors in the mean."""
    runs = [(1.0, 1.7, 1e-4), (50.0, 10.0, 1e-4), (100.0, 10.0, 1e-4)]
    truth = {"beta": BETA, "p0": 0.7124, "p[2]": 0.0461, "r[1]": 9.715}
    z = []
    for seed in range(5):
        taken = records(LAWS["linear"], seed, drive_noise=DRIVE_NOISE, shape=shape, runs=runs)
        found = hyst.identify(taken, family="rdpi", plays=3, delay=0)
        told = estimates(found)
        z += [(told[name][0] - value) / told[name][1] for name, value in truth.items()]
        assert any("was smoothed out before the fit" in note for note in found.undetermined)
    # Of 20 values (15 independent) at most 3 beyond two standard errors in 99 of 100 cases.
    assert np.count_nonzero(np.abs(z) > 2.0) <= 4
    assert np.abs(z).max() < 4.5


def test_standard_errors_count_what_is_left() -> None:
    taken = records(LAWS["linear"], seed=3, drive_noise=DRIVE_NOISE)
    smooth = [
        hyst.Record(without_noise(r)(r.u), r.y, dt=r.dt)  # type: ignore[misc]
        for r in taken
    ]
    told = hyst.identify(taken, family="rdpi", plays=3, delay=0)
    silent = hyst.identify(smooth, family="rdpi", plays=3, delay=0, rate_filter="none")
    assert np.array_equal(told.parameter_values, silent.parameter_values)
    assert np.all(told.standard_errors > silent.standard_errors)
    # Over 20 runs the scatter is 1.4 to 1.9 of what the residual alone would tell.
    assert 1.1 < np.median(told.standard_errors / silent.standard_errors) < 2.5


def test_a_validation_record_is_smoothed_alike() -> None:
    check = records(LAWS["linear"], 8, drive_noise=DRIVE_NOISE, runs=[(30.0, 5.0, 1e-4)])[0]
    taken = records(LAWS["linear"], 4, drive_noise=DRIVE_NOISE)
    found = hyst.identify(taken, family="rdpi", plays=3, delay=0, validation=check)
    raw = found.model.at_sample_time(1e-4)(check.u) - check.y
    assert found.metrics["validation"].rms < 1.15 * NOISE
    assert found.metrics["validation"].rms < np.std(raw)


def test_a_time_constant_that_is_given() -> None:
    taken = records(LAWS["linear"], 5, drive_noise=DRIVE_NOISE)
    found = hyst.identify(taken, family="rdpi", plays=3, delay=0, rate_filter=3e-4)
    # 1 / (2 pi 3e-4 s); the samples of the first record are 1e-3 s apart, too far for it.
    note = next(each for each in found.undetermined if "was smoothed out" in each)
    assert "of record 2, 3," in note
    assert "corner at 531 Hz" in note


@pytest.mark.parametrize("options", [{}, {"rate_filter": 3e-4}])
def test_noise_is_smoothed_before_a_lag_that_is_given(options: dict[str, float]) -> None:
    """Behind a lag noise is not white; the drive that is judged beside is the smoothed one."""
    runs = [(1.0, 1.7, 1e-4), (50.0, 10.0, 1e-4), (100.0, 10.0, 1e-4)]
    lag = hyst.Lag(1e-4, 1e-4)
    taken = []
    for seed, (frequency, periods, dt) in enumerate(runs):
        u = sine(frequency, periods, dt)
        y = plant(lag(u), dt, LAWS["linear"])
        output_noise = NOISE * np.random.default_rng(seed + 10).normal(size=u.size)
        taken.append(hyst.Record(noisy(u, seed), y + output_noise, dt=dt))
    found = hyst.identify(taken, family="rdpi", plays=3, delay=0, lag=1e-4, **options)
    (note,) = (each for each in found.undetermined if "was smoothed out" in each)
    # Beside the noisy drive 1.3 times the output's noise are left.
    assert found.metrics["training"].rms < 1.2 * NOISE
    beta, error = estimates(found)["beta"]
    assert abs(beta - BETA) < 4.0 * error
    if not options:
        noises = [float(each) for each in note.split("drive, ")[1].split(" rms")[0].split(" to ")]
        assert noises == pytest.approx([DRIVE_NOISE] * len(noises), rel=0.07)
        assert error < 0.004 * BETA  # 0.0019 of it without a lag
        assert found.verdict.level == "good"


def test_only_noisy_records_are_named() -> None:
    taken = records(LAWS["linear"], 6)
    taken[1] = hyst.Record(noisy(taken[1].u, 2), taken[1].y, dt=taken[1].dt)
    found = hyst.identify(taken, family="rdpi", plays=3, delay=0)
    assert any("noise of the measured drive of record 2," in note for note in found.undetermined)
