"""Scatter and best prediction against closed forms of balanced designs."""

from __future__ import annotations

import numpy as np
import pytest

from hyst.fleet.shared_shape.device_equations import LAGS, Equations
from hyst.fleet.shared_shape.noise import Noise
from hyst.fleet.shared_shape.population import Population
from hyst.fleet.shared_shape.variance_components import (
    Scatter,
    estimate_scatter,
    shared_where_possible,
)

SAMPLES, VARIANCE = 50, 0.04


def means_of(devices: np.ndarray, samples: int = SAMPLES) -> Equations:
    """Give equations of devices whose records are repeated readings of z itself."""
    count, size = devices.shape
    rows = np.broadcast_to(np.sqrt(samples) * np.eye(size), (count, size, size))
    left = np.full(count, VARIANCE * (samples - size))
    return Equations(
        rows=rows.copy(),
        along=np.sqrt(samples) * devices,
        rank=np.full(count, size),
        left=left,
        lagged=np.concatenate([left[:, None], np.zeros((count, LAGS))], axis=1),
        samples=np.full(count, samples),
        error=left,
    )


def start(size: int) -> Scatter:
    return Scatter(np.eye(size), np.full(size, 0.1), np.zeros(size), np.eye(size), -np.inf)


def estimated(devices: np.ndarray) -> Scatter:
    equations = means_of(devices)
    noise = np.full(len(devices), VARIANCE)
    weights = np.ones(len(devices))
    found = estimate_scatter(equations, noise, weights, start(devices.shape[1]), 200)
    return shared_where_possible(equations, noise, weights, found)


def test_variance_is_that_of_the_analysis_of_variance() -> None:
    devices = np.random.default_rng(0).normal([0.02, -0.01], [0.2, 0.1], (30, 2))
    found = estimated(devices)
    # Balanced one-way layout: between-device mean square less the noise of a mean.
    expected = np.var(devices, axis=0, ddof=1) - VARIANCE / SAMPLES
    assert found.variances == pytest.approx(expected, rel=0.03)
    assert found.mean == pytest.approx(devices.mean(axis=0), rel=0.02)


def test_variance_of_what_only_noise_scatters_is_zero() -> None:
    rng = np.random.default_rng(1)
    noise = np.sqrt(VARIANCE / SAMPLES)
    devices = np.column_stack([rng.normal(0.0, 0.5, 25), rng.normal(0.0, 0.7 * noise, 25)])
    found = estimated(devices)
    assert found.variances[1] == 0.0
    assert found.variances[0] > 0.1


def test_prediction_is_the_weighted_mean_of_device_and_fleet() -> None:
    devices = np.array([[0.8], [-0.3], [0.05]])
    noise = Noise(VARIANCE, 1e6, 1.0, 0.0)
    population = Population(np.array([[0.01]]), noise)
    means, covariances = population.posterior(means_of(devices))
    # z weighs as the fleet's variance over itself and that of the mean of the readings.
    weight = 0.01 / (0.01 + VARIANCE / SAMPLES)
    assert means == pytest.approx(weight * devices, rel=1e-4)
    assert covariances[:, 0, 0] == pytest.approx(np.full(3, (1.0 - weight) * 0.01), rel=1e-4)


def test_devices_that_share_all_are_predicted_by_the_mean() -> None:
    population = Population(np.zeros((1, 1)), Noise(VARIANCE, 1e6, 1.0, 0.0))
    means, covariances = population.posterior(means_of(np.array([[0.4]])))
    assert means[0, 0] == 0.0
    assert covariances[0, 0, 0] == 0.0


def test_distances_of_the_population_are_uniform_in_probability() -> None:
    rng = np.random.default_rng(2)
    spread = np.sqrt(0.01 + VARIANCE / SAMPLES)
    devices = rng.normal(0.0, spread, (2000, 3))
    population = Population(0.01 * np.eye(3), Noise(VARIANCE, 1e6, 1.0, 0.0))
    chances = population.chance(means_of(devices))
    below = [float(np.mean(chances < level)) for level in (0.05, 0.5, 0.95)]
    assert below == pytest.approx([0.05, 0.5, 0.95], abs=0.035)
