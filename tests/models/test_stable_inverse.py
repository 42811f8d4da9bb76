"""The noncausal inverse undoes any stable dynamics away from the edges of a record."""

from __future__ import annotations

import numpy as np
import pytest

from hyst.errors import NotInvertibleError
from hyst.models import LinearDynamics, StableInverse

RNG = np.random.default_rng(3)


@pytest.mark.parametrize(
    ("zeros", "poles"),
    [
        ([1.6], [0.5, 0.3]),
        ([1.6, 0.5], [0.9 * np.exp(0.3j), 0.9 * np.exp(-0.3j), 0.2]),
        ([-3.7, -0.27], [0.95, 0.9, 0.8]),
        ([0.99], [0.9]),
        ([1.002], [0.5]),
        ([], [0.5, 0.3, 0.1]),
    ],
)
@pytest.mark.parametrize("delay", [0, 5])
def test_undoes_the_dynamics(zeros: list[complex], poles: list[complex], delay: int) -> None:
    G = LinearDynamics.from_zeros_poles_gain(zeros, poles, 1.0, 0.01, delay)
    inverse = StableInverse.of(G)
    v = RNG.normal(size=40_000)
    error = (inverse(G(v)) - v)[inverse.valid(v.size)]
    assert error.size > 1000
    # The truncation tolerance times the gain of G, which is 1000 in the third case.
    assert np.abs(error).max() <= 1e-8 * np.ptp(v)


def test_paper_example_needs_one_sample_of_preview() -> None:
    G = LinearDynamics.from_continuous([3.391e10], [1.0, 3759.0, 2.063e7, 7.514e10], 0.01)
    inverse = StableInverse.of(G)
    assert inverse.preview == 1  # relative degree 1 and minimum phase
    assert inverse.h[0] == pytest.approx(1.0 / 0.256, rel=1e-3)  # printed leading coefficient


def test_coefficients_of_one_zero_outside() -> None:
    # 1/(1 - 2 z^-1) on the circle: -sum_{i>=1} 2^-i z^i.
    inverse = StableInverse.of(LinearDynamics.from_transfer_function([1.0, -2.0], [1.0, 0.0], 1.0))
    assert inverse.memory == 0
    expected = [-(2.0**-i) for i in range(4, 0, -1)] + [0.0]
    assert inverse.h[-5:] == pytest.approx(expected, abs=1e-14)
    assert inverse.max_gain == pytest.approx(1.0)  # |1 - 2| at 0 Hz
    assert inverse.noise_gain == pytest.approx(np.sqrt(1 / 3))  # sum of 4^-i


@pytest.mark.parametrize("zero", [-1.0, 1.0, 1.0005, 0.9995])
def test_a_zero_at_the_circle_is_named(zero: float) -> None:
    G = LinearDynamics.from_zeros_poles_gain([zero], [0.5, 0.3], 1.0, 0.01)
    with pytest.raises(NotInvertibleError, match=f"zero {zero:.6g}".replace("+", r"\+")):
        StableInverse.of(G)


def test_a_band_spares_a_zero_at_the_nyquist_frequency() -> None:
    G = LinearDynamics.from_zeros_poles_gain([-1.0], [0.5, 0.3], 1.0, 0.01)
    inverse = StableInverse.of(G, band=20.0)
    time = np.arange(8000) * 0.01
    v = np.sin(2 * np.pi * 3.0 * time) + 0.5 * np.sin(2 * np.pi * 17.0 * time)
    error = (inverse(G(v)) - v)[inverse.valid(v.size)]
    assert error.size > 1000
    assert np.abs(error).max() < 1e-9  # both tones lie inside the band
    assert inverse.max_gain < 10.0


def test_unstable_and_zero_systems_are_refused() -> None:
    with pytest.raises(NotInvertibleError, match="pole 1"):
        StableInverse.of(LinearDynamics.from_transfer_function([1.0], [1.0, -1.0], 1.0))
    with pytest.raises(NotInvertibleError, match="G is zero"):
        StableInverse.of(LinearDynamics([[0.5]], [0.0], [1.0], 0.0, 1.0))


def test_short_records_have_no_valid_samples() -> None:
    G = LinearDynamics.from_zeros_poles_gain([0.99], [0.9], 1.0, 0.01)
    inverse = StableInverse.of(G)
    edges = inverse.valid(50)
    assert inverse(np.ones(50))[edges].size == 0
