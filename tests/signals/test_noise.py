from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hyst.errors import InputError
from hyst.signals import estimate_noise, reversals, suggest_dead_band

TIME = np.arange(20_000) * 1e-3


@pytest.mark.parametrize("sigma", [1e-4, 1e-2, 0.1])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_the_level_of_white_noise_on_a_sine_is_found(sigma: float, seed: int) -> None:
    noise = sigma * np.random.default_rng(seed).standard_normal(TIME.size)
    # The median of N dependent values has a relative scatter of about 2 / sqrt(N) = 1.4 %
    # here; the curvature of the sine, 1e-6 a sample, is below the smallest sigma by 100.
    assert estimate_noise(np.sin(TIME) + noise) == pytest.approx(sigma, rel=0.05)


def test_outliers_and_corners_do_not_count() -> None:
    triangle = np.abs((TIME + 1.0) % 4.0 - 2.0)
    triangle[::100] += 5.0
    # Rounding of values near 2 is below 1e-15, the outliers are 5.
    assert estimate_noise(triangle) < 1e-14


@given(
    u=st.lists(st.floats(-1e3, 1e3), min_size=1, max_size=50),
    exponent=st.integers(-20, 20),
)
def test_both_scale_with_the_unit(u: list[float], exponent: int) -> None:
    # A power of two as the factor, so that scaling does not round; unless a value is so small
    # that it underflows.
    values = np.round(u, 6)
    for estimate in (estimate_noise, suggest_dead_band):
        assert estimate(values * 2.0**exponent) == estimate(values) * 2.0**exponent


@pytest.mark.parametrize("sigma", [0.0, 1e-3, 1e-2, 5e-2])
@pytest.mark.parametrize("seed", range(5))
def test_the_proposal_keeps_the_turns_of_a_noisy_sine(sigma: float, seed: int) -> None:
    noisy = np.sin(TIME) + sigma * np.random.default_rng(seed).standard_normal(TIME.size)
    # 20 s of sin(t): crests at pi/2 + k pi below 20, so k = 0 .. 5.
    assert reversals(noisy, suggest_dead_band(noisy)).size == 6


@pytest.mark.parametrize("level", [1e-3, 1e-2, 0.05])
@pytest.mark.parametrize("sigma_in_levels", [0.0, 0.1, 0.25, 0.5, 1.0])
def test_the_proposal_keeps_the_turns_of_a_quantised_sine(
    level: float, sigma_in_levels: float
) -> None:
    noise = level * sigma_in_levels * np.random.default_rng(7).standard_normal(TIME.size)
    quantised = level * np.round((np.sin(TIME) + noise) / level)
    assert reversals(quantised, suggest_dead_band(quantised)).size == 6


def test_a_noisy_ramp_has_no_turns() -> None:
    ramp = TIME + 0.5 * np.random.default_rng(5).standard_normal(TIME.size)
    assert reversals(ramp).size > 1000
    assert reversals(ramp, suggest_dead_band(ramp)).size == 0


def test_a_signal_of_two_levels_keeps_its_turns() -> None:
    square = np.tile([0.0, 0.0, 1.0, 1.0], 10)
    assert reversals(square, suggest_dead_band(square)).size == 18


@pytest.mark.parametrize("u", [[3.0], [3.0, 3.0], [3.0, 3.0, 3.0]])
def test_a_constant_signal_has_neither(u: list[float]) -> None:
    assert estimate_noise(u) == 0.0
    assert suggest_dead_band(u) == 0.0


def test_the_largest_doubles_do_not_overflow() -> None:
    # Range 2e308 is not a double, a quarter of it is.
    assert suggest_dead_band([1e308, -1e308, 1e308]) == pytest.approx(5e307, rel=1e-15)


def test_a_gap_is_refused() -> None:
    for estimate in (estimate_noise, suggest_dead_band):
        with pytest.raises(InputError, match="u is nan at index 1"):
            estimate([0.0, np.nan])


def test_a_measured_sine_of_40_s_at_1_hz_has_80_turns(measured_data: Path) -> None:
    table = np.loadtxt(measured_data / "piezo-dbo" / "Model_Vi_Do.dat")
    drive, displacement = table[:, 0], table[:, 4]
    assert reversals(drive, suggest_dead_band(drive)).size == 80
    assert reversals(displacement, suggest_dead_band(displacement)).size == 80
    assert reversals(displacement).size > 400
