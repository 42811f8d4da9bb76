"""Resonances and low-passes by frequency and damping."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.signal import cont2discrete

import hyst
from hyst import InputError

DT = 1e-4


def test_a_resonance_is_the_sampled_oscillator_of_its_differential_equation() -> None:
    made = hyst.models.resonance(200.0, 0.03, DT, gain=2.5, delay=3)
    w = 2.0 * math.pi * 200.0
    num, den, _ = cont2discrete(([2.5 * w * w], [1.0, 0.06 * w, w * w]), DT)
    u = np.random.default_rng(0).normal(size=300)
    expected = hyst.LinearDynamics.from_transfer_function(num[0], den, DT, 3)(u)
    # Two ways to the exponential of a matrix, and 300 samples of a mode that rings.
    np.testing.assert_allclose(made(u), expected, atol=1e-9)


@pytest.mark.parametrize("order", [1, 2])
def test_a_low_pass_loses_three_decibels_at_its_frequency(order: int) -> None:
    made = hyst.models.low_pass(50.0, DT, order, gain=4.0)
    assert made.order == order
    assert made.dc_gain() == pytest.approx(4.0, rel=1e-12)
    gain = abs(made.frequency_response(50.0)[0]) / 4.0
    # The held input adds sinc(f dt), 4e-5 at a two-hundredth of the rate.
    assert gain == pytest.approx(math.sqrt(0.5), rel=1e-3)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((0.0, 0.1, DT), "frequency"),
        ((5000.0, 0.1, DT), "not below half the sample rate, 5000 Hz"),
        ((200.0, -0.1, DT), "damping"),
        ((200.0, 0.1, 0.0), "dt"),
        ((200.0, 0.1, DT, float("nan")), "num"),
    ],
)
def test_what_makes_no_resonance(arguments: tuple[float, ...], said: str) -> None:
    with pytest.raises(InputError, match=said):
        hyst.models.resonance(*arguments)


def test_orders_of_low_passes() -> None:
    with pytest.raises(InputError, match="order"):
        hyst.models.low_pass(100.0, DT, order=3)
