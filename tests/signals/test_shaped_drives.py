"""Drives within limits that keep their amplitude, even values, held levels, noise."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from hyst import signals
from hyst.errors import InputError

Array = NDArray[np.float64]


def sizes(u: Array) -> Array:
    return np.asarray(np.abs(np.fft.rfft(u)))


def test_an_acceleration_limit_leaves_the_amplitude() -> None:
    # A flat spectrum had to shrink to an eighth here.
    wide = {"dt": 1e-4, "samples": 20_000, "amplitude": 10.0, "band": (1.0, 1000.0)}
    drive = signals.multisine(**wide, max_acceleration=2e7)
    scaled = signals.multisine(**wide, max_acceleration=2e7, keep="spectrum")
    assert np.abs(drive.u).max() == pytest.approx(10.0, rel=1e-12)
    assert drive.max_acceleration <= 2e7
    assert drive.max_acceleration > 0.99 * 2e7  # the limit is used
    assert np.abs(scaled.u).max() < 1.5
    assert "the amplitude is kept" in drive.notes[0]
    assert "scaled to" in scaled.notes[0]


@pytest.mark.parametrize("seed", [0, 1, 2])
@pytest.mark.parametrize("scale", [1.0, 1e-6])
def test_lines_fall_as_the_limits_do(seed: int, scale: float) -> None:
    drive = signals.multisine(
        1e-4,
        20_000,
        amplitude=10.0 * scale,
        band=(1.0, 1000.0),
        max_rate=6000.0 * scale,
        max_acceleration=6e6 * scale,
        seed=seed,
    )
    lines = np.arange(2, 2001)
    f, a = 0.5 * lines, sizes(drive.u)[lines]
    slope = np.gradient(np.log(a), np.log(f))
    # Below both corners nothing falls, above both all lines fall as 1/f^2.
    assert slope[0] == pytest.approx(0.0, abs=1e-6)
    assert slope[-1] == pytest.approx(-2.0, abs=1e-6)
    assert np.all(np.diff(a) <= 1e-9 * a[0])
    assert drive.max_rate <= 6000.0 * scale
    assert drive.max_acceleration <= 6e6 * scale


def test_without_need_nothing_is_shaped() -> None:
    plain = signals.multisine(1e-3, 1000, amplitude=2.0, band=(1.0, 100.0), seed=4)
    limited = signals.multisine(
        1e-3, 1000, amplitude=2.0, band=(1.0, 100.0), seed=4, max_rate=1e5, max_acceleration=1e9
    )
    assert np.array_equal(plain.u, limited.u)
    assert limited.notes == ()


def test_steeper_where_corners_do_not_do() -> None:
    # Lines of equal rate from the lowest on still are too fast: 2000 of them add up.
    drive = signals.multisine(1e-4, 20_000, amplitude=10.0, band=(1.0, 1000.0), max_rate=100.0)
    assert np.abs(drive.u).max() == pytest.approx(10.0, rel=1e-12)
    assert drive.max_rate <= 100.0
    assert "all lines fall as 1/f^" in drive.notes[0]


def test_pink_has_equal_power_in_octaves_and_a_corner_falls() -> None:
    pink = sizes(signals.multisine(1e-4, 20_000, rms=1.0, spectrum="pink").u)
    octaves = [float(np.square(pink[2**k : 2 ** (k + 1)]).sum()) for k in range(4, 12)]
    assert octaves == pytest.approx([octaves[0]] * 8, rel=0.04)  # sums of 16 lines for a logarithm
    flat = sizes(signals.multisine(1e-4, 20_000, rms=1.0, corner=100.0).u)
    assert flat[2:201] == pytest.approx(np.full(199, flat[2]), rel=1e-9)
    assert flat[400] == pytest.approx(0.5 * flat[200], rel=1e-9)


@pytest.mark.parametrize("band", [(0.5, 1000.0), (1.0, 100.0), (0.5, 4999.0)])
@pytest.mark.parametrize("amplitude", [1.0, 300.0])
def test_even_values_without_a_change_of_lines(band: tuple[float, float], amplitude: float) -> None:
    options = {"amplitude": amplitude, "band": band, "seed": 3}
    even = signals.multisine(1e-4, 20_000, uniform=True, **options)
    usual = signals.multisine(1e-4, 20_000, **options)
    counts = np.histogram(even.u, bins=10, range=(-amplitude, amplitude))[0] / even.u.size
    assert counts == pytest.approx(np.full(10, 0.1), abs=0.01)
    assert np.histogram(usual.u, bins=10, range=(-amplitude, amplitude))[0][0] < 0.01 * 20_000
    assert even.rms == pytest.approx(amplitude / math.sqrt(3.0), rel=0.02)
    lines = sizes(even.u)
    first, last = round(2 * band[0]), round(2 * band[1])
    assert lines[first : last + 1] == pytest.approx(np.full(last + 1 - first, lines[first]))
    assert lines[last + 1 :] == pytest.approx(0.0 * lines[last + 1 :], abs=1e-9 * lines[first])


@pytest.mark.parametrize("uniform", [False, True])
def test_noise_has_the_power_of_its_low_pass(uniform: bool) -> None:
    drive = signals.lowpassed_noise(1e-4, 65_536, 500.0, rms=2.0, uniform=uniform, seed=7)
    assert drive.rms == pytest.approx(2.0, rel=1e-9)
    f = np.fft.rfftfreq(65_536, 1e-4)
    power = np.square(sizes(drive.u))
    inside = power[(f > 10.0) & (f < 250.0)].mean()
    # Means of 330 and 130 lines of power by chance: 5.5 and 9 % to one sigma.
    near = (f > 475.0) & (f < 525.0)
    assert power[near].mean() / inside == pytest.approx(0.5, rel=0.22)
    assert power[(f > 990.0) & (f < 1010.0)].mean() / inside == pytest.approx(1 / 257.0, rel=0.36)


@pytest.mark.parametrize("hold", [1, 5, 7])
def test_levels_are_held_and_each_comes_once(hold: int) -> None:
    drive = signals.levels(1e-3, 700, 4.0, hold=hold, offset=1.0, periods=2)
    assert drive.period == 700 // hold * hold
    held = drive.u[: drive.period].reshape(-1, hold)
    assert np.array_equal(held, np.repeat(held[:, :1], hold, axis=1))
    assert np.sort(held[:, 0]) == pytest.approx(np.linspace(-3.0, 5.0, 700 // hold))
    assert np.array_equal(drive.u[: drive.period], drive.u[drive.period :])


def test_ramps_join_levels_and_leave_them_their_hold() -> None:
    drive = signals.levels(1e-3, 5000, 4.0, hold=6, max_rate=500.0, seed=2)
    assert drive.max_rate <= 500.0
    resting = np.diff(drive.u) == 0.0
    stretches = np.diff(np.flatnonzero(np.diff(np.r_[False, resting, False])))[::2]
    assert stretches.min() == 5  # six samples alike
    assert drive.period <= 5000
    assert drive.period > 4800
    ends = np.concatenate([drive.u[-1:], drive.u[:1]])
    assert abs(np.diff(ends)[0]) <= 0.5  # the next period begins within the limit, too


@pytest.mark.parametrize("spacing", ["linear", "logarithmic"])
@pytest.mark.parametrize("band", [(1.0, 1000.0), (1000.0, 1.0)])
def test_a_sweep_falls_only_where_limits_ask(spacing: str, band: tuple[float, float]) -> None:
    drive = signals.swept_sine(
        1e-4, 40_000, band, 10.0, spacing=spacing, max_rate=5000.0, max_acceleration=2e7, offset=3.0
    )
    assert drive.max_rate <= 5000.0
    assert drive.max_acceleration <= 2e7
    u = drive.u - 3.0
    crossings = np.flatnonzero(np.diff(np.signbit(u)))
    f = 0.5 / (np.diff(crossings) * 1e-4)
    tops = np.array([np.abs(u[a:b]).max() for a, b in pairwise(crossings)])
    # By hand: the rate is enough for 10 up to 5000 / (2 pi 10) = 79.6 Hz, and for a = 5000 / (2 pi
    # f) above; the acceleration asks for less from 5e6 / (2 pi 5000) = 637 Hz on.
    slow = (f > 3.0) & (f < 60.0)
    assert tops[slow].min() > 9.7
    fast = (f > 200.0) & (f < 300.0)
    # A half wave has about 20 samples, so its length is known to 5 %, and the median better.
    assert np.median(tops[fast] * f[fast]) == pytest.approx(5000.0 / (2 * math.pi), rel=0.03)


def test_a_sine_within_its_limits_is_left_alone() -> None:
    drive = signals.swept_sine(1e-4, 20_000, (5.0, 5.0), 10.0, max_rate=320.0)
    k = np.arange(20_000)
    assert drive.u == pytest.approx(10.0 * np.sin(2 * np.pi * 5e-4 * k), abs=1e-9)
    assert drive.notes == ()


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (
            lambda: signals.multisine(1e-4, 20_000, amplitude=10.0, band=(10, 99), max_rate=600.0),
            "max_rate is 600, but a sine of amplitude 10 at 10 Hz, the lowest line, needs 628",
        ),
        (
            lambda: signals.swept_sine(1e-4, 20_000, (10, 99), 10.0, max_acceleration=3e4),
            "max_acceleration is 30000, but a sine of amplitude 10 at 10 Hz, the lowest of the",
        ),
        (
            lambda: signals.swept_sine(1e-4, 9_000, (1, 999), 10.0, max_acceleration=1e4),
            "reaches only .* of the amplitude 10",
        ),
        (lambda: signals.multisine(0.01, 100, rms=1.0, spectrum="blue"), "spectrum is 'blue'"),
        (lambda: signals.multisine(0.01, 100, rms=1.0, corner=-1.0), "corner is -1.0"),
        (lambda: signals.multisine(0.01, 100, rms=1.0, keep="phase"), "keep is 'phase'"),
        (lambda: signals.lowpassed_noise(0.01, 100, 50.0, rms=1.0), "below half the sample rate"),
        (lambda: signals.lowpassed_noise(0.01, 100, 5.0, rms=1.0, order=0), "order is 0"),
        (
            lambda: signals.levels(0.01, 100, 1.0, hold=51),
            "hold is 51 samples and a period has 100",
        ),
        (lambda: signals.levels(0.01, 100, 1.0, max_rate=1.0), "are longer than a period of 100"),
        (lambda: signals.levels(0.01, 100, 1.0, hold=0), "hold is 0"),
        (lambda: signals.swept_sine(0.01, 99, (1, 9), 1.0, spacing="log"), "spacing is 'log'"),
        (lambda: signals.design("noise", dt=0.01), "noise needs a low pass"),
    ],
)
def test_what_cannot_be_is_refused_in_one_sentence(make: object, says: str) -> None:
    with pytest.raises(InputError, match=says):
        make()  # type: ignore[operator]
