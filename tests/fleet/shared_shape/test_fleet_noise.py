"""Noise of a fleet: how unlike devices are in it, and how many samples count as one."""

from __future__ import annotations

import numpy as np
import pytest

from hyst.fleet.shared_shape.device_equations import LAGS, Equations
from hyst.fleet.shared_shape.noise import noise_of


def left_by(rest: np.ndarray) -> Equations:
    """Give equations of devices of which only what is left matters; shape (devices, samples)."""
    count, samples = rest.shape
    lagged = np.array(
        [[each[lag:] @ each[: samples - lag] for lag in range(LAGS + 1)] for each in rest]
    )
    nothing = np.zeros((count, 1))
    return Equations(
        rows=nothing[:, :, None],
        along=nothing,
        rank=np.zeros(count, dtype=np.intp),
        left=lagged[:, 0],
        lagged=lagged,
        samples=np.full(count, samples),
        error=lagged[:, 0],
    )


def test_white_noise_counts_every_sample() -> None:
    rest = 0.1 * np.random.default_rng(0).standard_normal((40, 400))
    found = noise_of(left_by(rest))
    assert found.correlation == pytest.approx(1.0, abs=0.15)
    assert found.variance == pytest.approx(0.01, rel=0.05)
    assert found.lacking < 0.05 * found.variance


def test_error_that_goes_on_counts_few_samples() -> None:
    rng = np.random.default_rng(1)
    share = 0.8
    rest = np.zeros((40, 500))
    for k in range(1, 500):
        rest[:, k] = share * rest[:, k - 1] + rng.standard_normal(40)
    found = noise_of(left_by(rest))
    # Of a first-order autoregression (1 + a) / (1 - a) samples count as one.
    assert found.correlation == pytest.approx((1.0 + share) / (1.0 - share), rel=0.2)
    assert found.lacking == pytest.approx(share * found.variance, rel=0.1)


def test_devices_unlike_in_noise_are_drawn_less_to_the_fleet() -> None:
    rng = np.random.default_rng(2)
    alike = noise_of(left_by(rng.standard_normal((60, 300))))
    sizes = np.exp(0.7 * rng.standard_normal(60))[:, None]
    unlike = noise_of(left_by(sizes * rng.standard_normal((60, 300))))
    assert alike.freedom > 100.0
    assert unlike.freedom < 10.0
